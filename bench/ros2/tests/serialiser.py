"""Compare each structure of trundle-ros2 with rclpy, an independent serialiser: fields, values and lengths, in both directions.

--program is the example `interface_bytes` of crates/trundle-ros2. It writes each structure with distinct values as CDR; rclpy reads them,
each field must have the value that the program states, and the program must read rclpy's own bytes as the same. Then rclpy fills each
structure with values of its own, FILLINGS times, and the program must read them. The structures must be those of type_hashes.txt; the
hidden events of services are not sent by trundle.
Exit 0: equal. A line names each difference with structure, field and both values.
"""
import argparse
import array
import json
import pathlib
import random
import subprocess
import sys

import numpy as np
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_parser.definition import Array, BasicType, BoundedSequence, NamespacedType, UnboundedSequence

from echo_types import find_type

HASHES = pathlib.Path(__file__).with_name("type_hashes.txt")
# Values of rclpy's own for each structure. The first has empty sequences and extreme numbers, the others are random.
FILLINGS = 3
# Whole numbers of the interface definition language: least and largest value.
LIMITS = {f"{sign}int{bits}": ((0, 2**bits - 1) if sign else (-2**(bits - 1), 2**(bits - 1) - 1))
          for sign in ("", "u") for bits in (8, 16, 32, 64)}
# Hidden messages of services: trundle does not make them.
NOT_MADE = "_Event"


def program(path, mode, lines=()):
    """`{name: [(bytes, fields), ...]}` in the order of the program's lines."""
    done = subprocess.run([path, mode], input="\n".join(lines), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"serialiser: {path} {mode} ended with {done.returncode}: {done.stderr}")
    found = {}
    for line in done.stdout.splitlines():
        name, data, fields = line.split(" ", 2)
        found.setdefault(name, []).append((bytes.fromhex(data), json.loads(fields)))
    return found


def plain(value):
    """A message as Python's dictionaries, lists, numbers and text; bytes as lists of numbers."""
    if hasattr(value, "get_fields_and_field_types"):
        return {field: plain(getattr(value, field)) for field in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if isinstance(value, (list, tuple, array.array, np.ndarray)):
        return [plain(v) for v in value]
    return value.item() if isinstance(value, np.generic) else value


def without_placeholder(fields):
    """The fields without the byte that stands for a structure without members."""
    if isinstance(fields, dict):
        return {k: without_placeholder(v) for k, v in fields.items() if k != "structure_needs_at_least_one_member"}
    return [without_placeholder(v) for v in fields] if isinstance(fields, list) else fields


def difference(theirs, ours, where=""):
    """`None` if equal, else the first difference as text."""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        if list(theirs) != sorted(ours, key=list(theirs).index) if set(theirs) == set(ours) else True:
            return f"{where or 'fields'}: rclpy has {list(theirs)}, trundle {list(ours)}"
        return next((d for d in (difference(theirs[k], ours[k], f"{where}.{k}") for k in theirs) if d), None)
    if isinstance(theirs, list) and isinstance(ours, list) and len(theirs) == len(ours):
        return next((d for d in (difference(t, o, f"{where}[{i}]") for i, (t, o) in enumerate(zip(theirs, ours))) if d), None)
    same = type(theirs) is type(ours) or {type(theirs), type(ours)} == {int, float}
    return None if same and theirs == ours else f"{where}: rclpy has {theirs!r}, trundle {ours!r}"


class Filler:
    """Fills messages of rclpy. The first filling is of extremes and empty sequences, the others are random."""

    def __init__(self, number):
        self.extreme, self.random = number == 0, random.Random(number)

    def number(self, kind):
        if kind == "boolean":
            return self.extreme or self.random.random() < 0.5
        if kind == "octet":
            return bytes([255 if self.extreme else self.random.randrange(256)])
        if kind in LIMITS:
            least, largest = LIMITS[kind]
            return self.random.choice([least, largest]) if self.extreme else self.random.randint(least, largest)
        value = sys.float_info.max if self.extreme and kind == "double" else self.random.uniform(-1e3, 1e3)
        return float(np.float32(value)) if kind == "float" else value

    def text(self):
        return "" if self.extreme else "".join(self.random.choice("ab\u00e9\u4e2d /") for _ in range(self.random.randrange(9)))

    def length(self, kind):
        largest = min(getattr(kind, "maximum_size", 5), 5)
        return 0 if self.extreme else self.random.randint(0, largest)

    def value(self, kind):
        if isinstance(kind, Array):
            return [self.value(kind.value_type) for _ in range(kind.size)]
        if isinstance(kind, (UnboundedSequence, BoundedSequence)):
            return [self.value(kind.value_type) for _ in range(self.length(kind))]
        if isinstance(kind, NamespacedType):
            return self.message(find_type("/".join(kind.namespaced_name())))
        return self.number(kind.typename) if isinstance(kind, BasicType) else self.text()

    def message(self, kind):
        message = kind()
        for field, slot in zip(message.get_fields_and_field_types(), kind.SLOT_TYPES):
            setattr(message, field, self.value(slot))
        return message


def accepted(name, message):
    """The message with values that the client library of trundle takes: its structures of goals know the states 0 to 6 and times
    after 1970 with less than a second of nanoseconds."""
    if name.endswith("_GetResult_Response"):
        message.status = abs(message.status) % 7
    if name.endswith("_SendGoal_Response"):
        message.stamp.sec, message.stamp.nanosec = abs(message.stamp.sec) % 2**31, message.stamp.nanosec % 10**9
    return message


def check_names(names):
    """Structures of the table that the program lacks, and the other way round."""
    table = {line.split()[0] for line in HASHES.read_text().splitlines()}
    kinds = {n for n in table if not n.endswith(NOT_MADE)}
    # Services and actions themselves have a hash but no bytes.
    kinds = {n for n in kinds if n.split("/")[1] == "msg" or "_" in n.split("/")[2]}
    kinds = {n for n in kinds if n.rsplit("_", 1)[0] not in table or not n.endswith(("_SendGoal", "_GetResult"))}
    return [f"{n}: only in {'the table' if n in kinds else 'the program'}" for n in sorted(kinds ^ set(names))]


def check_written(path):
    """The program's own values: read by rclpy, and read again by the program from rclpy's bytes."""
    problems, lines, written = [], [], program(path, "write")
    for name, [(data, fields)] in written.items():
        kind = find_type(name)
        message = deserialize_message(data, kind)
        again = serialize_message(message)
        found = difference(plain(message), without_placeholder(fields))
        # rclpy fills messages of a fixed size up to a multiple of 4 bytes.
        if not found and not 0 <= len(again) - len(data) <= 3:
            found = f"rclpy writes {len(again)} bytes, trundle {len(data)}"
        problems += [f"{name}: {found}"] if found else []
        lines.append(f"{name} {again.hex()}")
    for name, [(_, fields)] in program(path, "read", lines).items():
        found = difference(without_placeholder(written[name][0][1]), without_placeholder(fields))
        problems += [f"{name}: read from rclpy's bytes: {found}"] if found else []
    return problems + check_names(written), list(written)


def check_read(path, names):
    """Values of rclpy's own: read by the program, and read again by rclpy from the program's bytes."""
    problems, sent = [], []
    for number in range(FILLINGS):
        for name in names:
            message = accepted(name, Filler(number).message(find_type(name)))
            sent.append((name, message, serialize_message(message)))
    answers = program(path, "read", [f"{name} {data.hex()}" for name, _, data in sent])
    for name, message, _ in sent:
        data, fields = answers[name].pop(0)
        found = difference(plain(message), without_placeholder(fields))
        if not found and plain(deserialize_message(data, type(message))) != plain(message):
            found = "trundle's bytes of rclpy's values are not read as the same"
        problems += [f"{name}: {found}"] if found else []
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    path = parser.parse_args().program
    problems, names = check_written(path)
    problems += check_read(path, names)
    for problem in problems:
        print(problem)
    print(f"serialiser: {len(names)} structures, {1 + FILLINGS} times each, {len(problems)} differences")
    return 1 if problems or not names else 0


if __name__ == "__main__":
    sys.exit(main())
