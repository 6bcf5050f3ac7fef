"""Build the Python packages of ROS 2 interfaces that PyPI lacks, from the project's own table.

Run by the Python of the folder that get-ros2.sh makes. The rosidl generators of the installed wheels write C, C++ and Python;
the machine's C and C++ compilers make the libraries. Input: crates/trundle-ros2/interfaces/<package>. Output: <prefix>/lib,
<prefix>/lib/pythonX.Y/site-packages/<package>, <prefix>/share/<package>. A package whose table did not change is left alone.
"""
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor

PACKAGES = ["tf2_msgs", "map_msgs", "nav2_msgs"]
TABLE = pathlib.Path(__file__).resolve().parents[2] / "crates/trundle-ros2/interfaces"
PREFIX = pathlib.Path(sys.prefix)
SHARE = PREFIX / "share"
SITE = pathlib.Path(sysconfig.get_paths()["platlib"])
# Runtime libraries that generated code calls.
RUNTIME = ["rosidl_runtime_c", "rcutils", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c",
           "rosidl_typesupport_fastrtps_cpp", "rosidl_typesupport_introspection_c", "fastcdr", "rmw"]
# Type supports that rmw_fastrtps_cpp asks for: one serialises, one describes the type to DDS.
SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]
# Generators whose output is compiled.
COMPILED = ["rosidl_generator_c", *SUPPORTS, "rosidl_typesupport_c", "rosidl_generator_py"]


def run(arguments, **options):
    """Run a command; on failure end the program with its output."""
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"build_interfaces: {' '.join(map(str, arguments))[:300]} ended with {done.returncode}:\n{done.stdout}{done.stderr}")


def table_hash(package):
    """Hash of the package's files and of this program."""
    digest = hashlib.sha256(pathlib.Path(__file__).read_bytes())
    for file in sorted((TABLE / package).glob("*/*.*")):
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()


def interface_packages():
    """Names of the installed packages that hold interfaces."""
    return sorted(p.parent.name for p in SHARE.glob("*/msg") if (p.parent / "package.xml").exists())


def dependency_idls():
    """`package:path of the IDL file` of every installed interface, as the generators expect it."""
    return [f"{p}:{f}" for p in interface_packages() for f in sorted((SHARE / p).glob("*/*.idl"))]


def number_parts(text):
    """A comment on the first line of each part: the generators mix up two equal constants of one action unless a comment tells them apart.

    The comment block before the first empty line counts as one of the file, so there are two.
    """
    return "---\n".join(f"# file\n\n# part {number}\n{part}" for number, part in enumerate(text.split("---\n")))


class Build:
    """The folder in which one package is generated and compiled."""

    def __init__(self, package, folder):
        self.package, self.folder = package, folder / package
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.idl_tuples = self.convert_to_idl()

    def path(self, generator):
        return self.folder / generator / self.package

    def convert_to_idl(self):
        """Interface files to IDL; returns `base folder:relative path` of each."""
        source = self.folder / "source"
        names = [str(f.relative_to(TABLE / self.package)) for f in sorted((TABLE / self.package).glob("*/*.*"))]
        for name in names:
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_text(number_parts((TABLE / self.package / name).read_text()))
        arguments = self.folder / "adapter.json"
        arguments.write_text(json.dumps({"non_idl_tuples": [f"{source}:{n}" for n in names]}))
        listed = self.folder / "idls.txt"
        run([sys.executable, "-m", "rosidl_adapter", "--package-name", self.package, "--arguments-file", arguments,
             "--output-dir", self.path("idl"), "--output-file", listed])
        return listed.read_text().split()

    def generate(self, generator, *options, **extra):
        """Run one generator of the wheels."""
        values = {"package_name": self.package, "idl_tuples": self.idl_tuples, "output_dir": str(self.path(generator)),
                  "ros_interface_dependencies": dependency_idls(), "target_dependencies": [],
                  "template_dir": str(SHARE / generator / "resource"), "ros_interface_files": []} | extra
        arguments = self.folder / f"{generator}.json"
        arguments.write_text(json.dumps(values))
        run([sys.executable, PREFIX / "lib" / generator / generator, "--generator-arguments-file", arguments, *options])
        for template in (SHARE / generator / "resource").glob("*visibility_control.h.in"):
            text = template.read_text().replace("@PROJECT_NAME_UPPER@", self.package.upper()).replace("@PROJECT_NAME@", self.package)
            target = self.path(generator) / "msg" / template.name.removesuffix(".in")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)

    def generate_all(self):
        (self.path("rosidl_generator_py")).mkdir(parents=True)
        paths = [f"{p}:{SHARE / p}" for p in interface_packages()]
        self.generate("rosidl_generator_type_description", include_paths=paths)
        described = self.path("rosidl_generator_type_description")
        tuples = [f"{f.parent.name}/{f.stem}.idl:{f}" for f in sorted(described.glob("*/*.json"))]
        self.generate("rosidl_generator_c", type_description_tuples=tuples)
        for support in SUPPORTS:
            self.generate(support)
        self.generate("rosidl_typesupport_c", "--typesupports", *SUPPORTS)
        self.generate("rosidl_generator_py", "--typesupport-impls", "rosidl_typesupport_c")

    def includes(self):
        import numpy
        folders = [self.path(g).parent for g in COMPILED]
        folders += [f for f in (PREFIX / "include").iterdir() if f.is_dir()] + [PREFIX / "include"]
        folders += [sysconfig.get_paths()["include"], numpy.get_include()]
        return [f"-I{f}" for f in folders]

    def compile(self, sources):
        """Object files of the sources, two at a time."""
        includes = self.includes()

        def one(source):
            target = self.folder / "objects" / (str(source.relative_to(self.folder)).replace("/", "_") + ".o")
            target.parent.mkdir(exist_ok=True)
            compiler = [os.environ.get("CXX", "g++"), "-std=c++17"] if source.suffix == ".cpp" else [os.environ.get("CC", "gcc")]
            run([*compiler, "-c", "-O0", "-fPIC", "-w", *includes, source, "-o", target])
            return target

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(one, sources))

    def link(self, target, objects, libraries):
        needed = [PREFIX / "lib" / f"lib{n}.so" for n in RUNTIME]
        up = os.path.relpath(PREFIX / "lib", target.parent)
        run([os.environ.get("CXX", "g++"), "-shared", "-o", target, *objects, *libraries, *needed, f"-Wl,-rpath,$ORIGIN/{up}",
             "-Wl,--allow-shlib-undefined"])

    def dependencies(self, suffix):
        """The libraries of one generator in the other interface packages."""
        names = [p for p in interface_packages() if p != self.package]
        return [f for f in (PREFIX / "lib" / f"lib{p}__{suffix}.so" for p in names) if f.exists()]

    def library(self, suffix, sources, linked):
        target = PREFIX / "lib" / f"lib{self.package}__{suffix}.so"
        self.link(target, self.compile(sources), linked + self.dependencies(suffix))
        return target

    def install(self):
        """Compile the libraries and copy the Python package and the interface files."""
        sources = {g: sorted(self.path(g).rglob("*.c")) + sorted(self.path(g).rglob("*.cpp")) for g in COMPILED}
        structs = self.library("rosidl_generator_c", sources["rosidl_generator_c"], [])
        for support in SUPPORTS:
            self.library(support, sources[support], [structs])
        dispatch = self.library("rosidl_typesupport_c", sources["rosidl_typesupport_c"], [structs])
        python = self.path("rosidl_generator_py")
        (python / "__init__.py").touch()
        extension = python / f"{self.package}_s__rosidl_typesupport_c.so"
        target = SITE / self.package
        shutil.rmtree(target, ignore_errors=True)
        objects = self.compile(sources["rosidl_generator_py"])
        shutil.copytree(python, target, ignore=shutil.ignore_patterns("*.c"))
        self.link(target / extension.name, objects, [dispatch, structs, *self.dependencies("rosidl_generator_py"),
                                                     *self.dependencies("rosidl_generator_c")])
        self.copy_share()

    def copy_share(self):
        target = SHARE / self.package
        shutil.rmtree(target, ignore_errors=True)
        for source in (TABLE / self.package, self.path("idl"), self.path("rosidl_generator_type_description")):
            shutil.copytree(source, target, dirs_exist_ok=True)
        index = SHARE / "ament_index/resource_index/packages"
        index.mkdir(parents=True, exist_ok=True)
        (index / self.package).touch()


def main():
    for package in PACKAGES:
        stamp = SHARE / package / "table.sha256"
        wanted = table_hash(package)
        if stamp.exists() and stamp.read_text() == wanted:
            print(f"{package}: up to date")
            continue
        build = Build(package, PREFIX / "build")
        build.generate_all()
        build.install()
        stamp.write_text(wanted)
        shutil.rmtree(build.folder)
        print(f"{package}: built {len(build.idl_tuples)} interfaces")


if __name__ == "__main__":
    main()
