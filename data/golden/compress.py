"""Copies an MCAP file with its chunks compressed (zstd): compress.py IN OUT. Needs `pip install mcap`."""

import sys

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

source, target = sys.argv[1:]
with open(source, "rb") as incoming, open(target, "wb") as outgoing:
    reader = make_reader(incoming)
    writer = Writer(outgoing, compression=CompressionType.ZSTD, chunk_size=4 << 20)
    writer.start(profile=reader.get_header().profile)
    schemas, channels = {}, {}
    for schema, channel, message in reader.iter_messages(log_time_order=False):
        if schema.id not in schemas:
            schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
        if channel.id not in channels:
            channels[channel.id] = writer.register_channel(
                channel.topic, channel.message_encoding, schemas[schema.id], channel.metadata
            )
        writer.add_message(
            channels[channel.id], message.log_time, message.data, message.publish_time, message.sequence
        )
    writer.finish()
