/** ROS 1 bags, read by @foxglove/rosbag: chunks are found by the index and may be compressed by LZ4 or bzip2. */
import { Bag } from "@foxglove/rosbag";
import { decode as bunzip2 } from "@openpgp/seek-bzip";
import { badFile } from "../../errors.js";
import { lz4 } from "./lz4.js";
import { decoderOf } from "./messages.js";
import { type RosFile, RosSource, type RosTopic, byName, chunkSize } from "./ros-source.js";
import type { Bytes, Source } from "./source.js";

const DECOMPRESS = {
  lz4: (bytes: Uint8Array, size: number) => lz4(bytes, chunkSize(size)),
  bz2: (bytes: Uint8Array, size: number) => bunzip2(bytes, new Uint8Array(chunkSize(size))),
};

interface Time {
  sec: number;
  nsec: number;
}
const seconds = ({ sec, nsec }: Time): number => sec + nsec * 1e-9;
const timeOf = (time: number): Time => {
  const sec = Math.floor(Math.max(0, time));
  return { sec, nsec: Math.min(999_999_999, Math.max(0, Math.floor((time - sec) * 1e9))) };
};
/** Seconds by which a double may round a Unix time. */
const ROUNDING = 1e-6;

function topicsOf(bag: Bag): RosTopic[] {
  const counts = new Map<number, number>();
  for (const { connections } of bag.chunkInfos)
    for (const { conn, count } of connections) counts.set(conn, (counts.get(conn) ?? 0) + count);
  return byName(
    [...bag.connections.values()].map(({ conn, topic, type = "", messageDefinition }) => ({
      name: topic,
      type,
      count: counts.get(conn) ?? 0,
      by: () => decoderOf("ros1", { encoding: "ros1msg", definition: messageDefinition }),
    })),
  );
}

async function opened(bytes: Bytes): Promise<Bag> {
  const bag = new Bag(
    { size: () => bytes.size, read: (from, length) => bytes.read(from, length) },
    { parse: false, decompress: DECOMPRESS },
  );
  try {
    await bag.open();
  } catch (error) {
    throw badFile(
      "this bag has no index: its recording was interrupted, or the file is cut off; `rosbag reindex FILE` repairs it",
      error,
    );
  }
  if (bag.chunkInfos.length === 0)
    throw badFile(
      "this bag holds no messages or was not closed; if it was not closed, `rosbag reindex FILE` repairs it",
    );
  return bag;
}

export async function openBag(bytes: Bytes): Promise<Source> {
  const bag = await opened(bytes);
  const starts = bag.chunkInfos.map(({ startTime }) => seconds(startTime));
  const ends = bag.chunkInfos.map(({ endTime }) => seconds(endTime));
  const span: [number, number] = [Math.min(...starts), Math.max(...ends)];
  async function* messages(names: readonly string[], from: number, until: number) {
    for await (const { topic, timestamp, data } of bag.messageIterator({
      topics: [...names],
      start: timeOf(from - ROUNDING),
    })) {
      const time = seconds(timestamp);
      if (time > until + ROUNDING) return;
      yield { topic, time, bytes: data };
    }
  }
  const file: RosFile = { format: "ROS 1 bag", topics: topicsOf(bag), span, messages };
  return new RosSource(file);
}
