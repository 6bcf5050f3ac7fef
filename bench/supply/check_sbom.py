"""Checks a list of parts (SBOM): valid by CycloneDX's published schema, and the packages that `cargo tree` prints, no more and no fewer.

usage: cargo tree --edges normal --prefix none ... | check_sbom.py FILE SCHEMAS
SCHEMAS: the folder of the schemas in the package cyclonedx-python-lib.
"""

import json
import pathlib
import sys

import fastjsonschema


def schema(folder, name):
    return json.loads((folder / f"{name.removesuffix('.schema.json').removesuffix('.SNAPSHOT')}.SNAPSHOT.schema.json").read_text())


def validate(sbom, folder):
    """Raises an error with the place of the first fault."""
    published = schema(folder, f"bom-{sbom['specVersion']}")
    other = {"http": lambda uri: schema(folder, uri.rsplit("/", 1)[1])}
    # Formats of texts (dates, addresses) are not checked: the validator knows few of them.
    fastjsonschema.compile(published, handlers=other, use_formats=False)(sbom)


def compiled(lines):
    """Name and version of each package: `serde v1.0.0 (*)`."""
    words = [line.split() for line in lines if line.strip()]
    return {(name, version.removeprefix("v")) for name, version, *_ in words}


def main():
    path, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    sbom = json.loads(pathlib.Path(path).read_text())
    validate(sbom, folder)
    program = sbom["metadata"]["component"]
    listed = [(part["name"], part["version"]) for part in [program, *sbom["components"]]]
    expected = compiled(sys.stdin)
    findings = [f"{name} {version} is missing" for name, version in sorted(expected - set(listed))]
    findings += [f"{name} {version} is not compiled" for name, version in sorted(set(listed) - expected)]
    findings += [f"{name} {version} stands twice" for name, version in sorted(set(listed)) if listed.count((name, version)) > 1]
    findings += [] if expected else ["cargo tree printed no package"]
    print("\n".join(findings) or f"{len(listed)} packages, CycloneDX {sbom['specVersion']}")
    return 1 if findings else 0


sys.exit(main())
