"""Compare crates/trundle-ros2/interfaces with the interface files of the installed wheels.

Every file that a wheel has too must state the same fields, constants and defaults in the same order.
Run by the Python of the folder that get-ros2.sh makes. Exit 0: equal.
"""
import pathlib
import re
import sys

TABLE = pathlib.Path(__file__).resolve().parents[3] / "crates/trundle-ros2/interfaces"
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
    """None where equal, else the first difference as text."""
    other = share / file.relative_to(TABLE)
    if not other.exists():
        return f"{other}: no such file in the wheels"
    ours, theirs = statements(file.read_text()), statements(other.read_text())
    if ours == theirs:
        return None
    pairs = list(zip(ours + ["(end)"], theirs + ["(end)"]))
    line, pair = next((i, p) for i, p in enumerate(pairs) if p[0] != p[1])
    return f"{file.relative_to(TABLE)} statement {line + 1}: here '{pair[0]}', in the wheel '{pair[1]}'"


def main():
    share = pathlib.Path(sys.prefix) / "share"
    files = [f for f in sorted(TABLE.glob("*/*/*.*")) if f.parts[-3] not in MADE_OF_TABLE]
    differences = [d for d in (compare(f, share) for f in files) if d]
    for difference in differences:
        print(difference)
    print(f"interfaces: {len(files)} files compared with {share}, {len(differences)} differ")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
