"""Compare crates/trundle-ros2/interfaces with the interface files of the installed wheels, and type_hashes.txt with their generators.

Every file that a wheel has too must state the same fields, constants and defaults in the same order. type_hashes.txt holds a line
`package/kind/Name RIHS01_...` for each type of the table, parts of services and actions included; --write writes it.
Run by the Python of the folder that get-ros2.sh makes. Exit 0: equal.
"""
import json
import pathlib
import re
import sys

TABLE = pathlib.Path(__file__).resolve().parents[3] / "crates/trundle-ros2/interfaces"
HASHES = pathlib.Path(__file__).with_name("type_hashes.txt")
MADE_OF_TABLE = {"tf2_msgs", "map_msgs", "nav2_msgs"}


def statements(text):
    """The lines of an interface file without comments, spaces normalised."""
    found = []
    for line in text.splitlines():
        line = re.match(r"""((?:[^#"']|"[^"]*"|'[^']*')*)""", line).group(1).strip()
        if line:
            found.append(re.sub(r"\s*=\s*", "=", re.sub(r"\s+", " ", line)))
    return found


def compare(file, share):
    """`None` if equal, else the first difference as text."""
    other = share / file.relative_to(TABLE)
    if not other.exists():
        return f"{other}: no such file in the wheels"
    ours, theirs = statements(file.read_text()), statements(other.read_text())
    if ours == theirs:
        return None
    pairs = list(zip(ours + ["(end)"], theirs + ["(end)"]))
    line, pair = next((i, p) for i, p in enumerate(pairs) if p[0] != p[1])
    return f"{file.relative_to(TABLE)} statement {line + 1}: here '{pair[0]}', in the wheel '{pair[1]}'"


def type_hashes(share):
    """Lines of the types that the table's files define, as the generators hashed them."""
    lines = set()
    for file in sorted(TABLE.glob("*/*/*.*")):
        name = f"{file.parts[-3]}/{file.parts[-2]}/{file.stem}"
        described = json.loads((share / file.relative_to(TABLE)).with_suffix(".json").read_text())
        lines |= {f"{t['type_name']} {t['hash_string']}" for t in described["type_hashes"]
                  if t["type_name"] == name or t["type_name"].startswith(f"{name}_")}
    return "\n".join(sorted(lines)) + "\n"


def main():
    share = pathlib.Path(sys.prefix) / "share"
    files = [f for f in sorted(TABLE.glob("*/*/*.*")) if f.parts[-3] not in MADE_OF_TABLE]
    differences = [d for d in (compare(f, share) for f in files) if d]
    for difference in differences:
        print(difference)
    print(f"interfaces: {len(files)} files compared with {share}, {len(differences)} differ")
    hashes = type_hashes(share)
    if "--write" in sys.argv:
        HASHES.write_text(hashes)
    same = HASHES.exists() and HASHES.read_text() == hashes
    print(f"interfaces: {len(hashes.splitlines())} type hashes {'equal' if same else 'differ from'} {HASHES.name}")
    return 1 if differences or not same else 0


if __name__ == "__main__":
    sys.exit(main())
