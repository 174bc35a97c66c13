"""ROS 1 bags for the tests of recordings, written by an independent program, `rosbags`.

    pip install rosbags
    node tests/contract/recorded-messages.mjs > target/messages.json
    python scripts/reference/recording.py target/messages.json tests/fixtures/recordings
"""

import base64
import json
import sys
from pathlib import Path

from rosbags.rosbag1 import Writer

COMPRESSIONS = {"none": None, "lz4": Writer.CompressionFormat.LZ4, "bz2": Writer.CompressionFormat.BZ2}


def write(path, messages, compression):
    path.unlink(missing_ok=True)
    writer = Writer(path)
    if compression is not None:
        writer.set_compression(compression)
    with writer:
        connections = {}
        for message in messages:
            topic = message["topic"]
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic, message["type"].replace("/", "/msg/"), msgdef=message["definition"], md5sum="0" * 32
                )
            writer.write(connections[topic], int(message["nanoseconds"]), base64.b64decode(message["bytes"]))


def main(source, folder):
    messages = json.loads(Path(source).read_text())
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "walk-lz4.bag", messages, COMPRESSIONS["lz4"])
    # Messages without pictures suffice to distinguish the other two.
    few = [message for message in messages if "image_raw" not in message["topic"] or "Depth" in message["topic"]]
    write(folder / "depth-none.bag", few[:8], COMPRESSIONS["none"])
    write(folder / "depth-bz2.bag", few[:8], COMPRESSIONS["bz2"])


main(*sys.argv[1:])
