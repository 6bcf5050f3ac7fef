"""Decode messages by rclpy and serialise them again, so that another serialiser can be compared.

Input, a file or stdin: lines `package/kind/Name HEX`, kind msg, srv or action, HEX the CDR bytes with their four bytes of header.
Parts of services and actions are named as in Python: `std_srvs/srv/Trigger_Request`, `nav2_msgs/action/Spin_SendGoal_Request`,
`nav2_msgs/action/Spin_FeedbackMessage`. `package/kind/Name default` asks for a message of defaults.
Output, a line each: JSON with `type`, `type_hash`, `message`, `hex`, or with `type` and `error`. `hex` is rclpy's own serialisation of the
decoded message. Fast CDR leaves padding as it lies in memory; up to LARGEST_PROBED_BYTES padding is found and written as zero, so that
`hex` equals the input of a serialiser that pads with zero. Exit 0: every line was decoded.
"""
import argparse
import array
import contextlib
import importlib
import json
import math
import os
import pathlib
import sys

import numpy as np
from rclpy.serialization import deserialize_message, serialize_message

# Longest message whose padding is searched for, bytes.
LARGEST_PROBED_BYTES = 4096


def find_type(name):
    """The Python class of `package/kind/Name`."""
    package, kind, rest = name.split("/")
    module = importlib.import_module(f"{package}.{kind}")
    holder = module
    parts = rest.split("_")
    for i, part in enumerate(parts):
        if hasattr(holder, part):
            holder = getattr(holder, part)
        elif i and hasattr(holder, "Impl") and part in ("SendGoal", "GetResult", "FeedbackMessage"):
            holder = {"SendGoal": holder.Impl.SendGoalService, "GetResult": holder.Impl.GetResultService,
                      "FeedbackMessage": holder.Impl.FeedbackMessage}[part]
        else:
            raise ValueError(f"{name}: {package}.{kind} has no {rest}")
    return holder


def type_hash(name):
    """The type's hash as the generators wrote it, `None` if they did not."""
    package, folder, rest = name.split("/")
    file = pathlib.Path(sys.prefix) / "share" / package / folder / f"{rest.split('_')[0]}.json"
    if not file.exists():
        return None
    for entry in json.loads(file.read_text())["type_hashes"]:
        if entry["type_name"] == name:
            return entry["hash_string"]
    return None


def plain(value):
    """A message as JSON: numbers that JSON lacks become text, bytes become hex."""
    if hasattr(value, "get_fields_and_field_types"):
        return {field: plain(getattr(value, field)) for field in value.get_fields_and_field_types()}
    if isinstance(value, (bytes, bytearray)):
        return value.hex()
    if isinstance(value, (list, tuple, array.array, np.ndarray)):
        return [plain(v) for v in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def without_padding(data, kind):
    """The bytes with padding as zero. A byte after the header is padding where a change of its lowest bit changes nothing."""
    if len(data) > LARGEST_PROBED_BYTES:
        return data
    found, message = bytearray(data), plain(deserialize_message(data, kind))
    with quiet_errors():
        for i in range(4, len(data)):
            changed = bytearray(data)
            changed[i] ^= 1
            try:
                if plain(deserialize_message(bytes(changed), kind)) == message:
                    found[i] = 0
            except Exception:
                continue
    return bytes(found)


@contextlib.contextmanager
def quiet_errors():
    """The C library prints about lengths that the search made wrong; keep that off stderr."""
    kept = os.dup(2)
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def decode(line):
    """The answer to one line of input."""
    name, data = line.split()
    try:
        kind = find_type(name)
        message = kind() if data == "default" else deserialize_message(bytes.fromhex(data), kind)
        return {"type": name, "type_hash": type_hash(name), "message": plain(message),
                "hex": without_padding(serialize_message(message), kind).hex()}
    except Exception as error:
        return {"type": name, "error": f"{type(error).__name__}: {error}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", help="default: stdin")
    options = parser.parse_args()
    failed = 0
    with open(options.file) if options.file else sys.stdin as lines:
        for line in lines:
            if line.strip() and not line.startswith("#"):
                answer = decode(line)
                failed += "error" in answer
                print(json.dumps(answer, allow_nan=False), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
