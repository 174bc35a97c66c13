/** MCAP files, the container of ROS 2, read by @mcap/core: chunks are found by the index; a file without one is read whole. */
import { type DecompressHandlers, McapIndexedReader, McapStreamReader, type McapTypes } from "@mcap/core";
import { decompress as zstd } from "fzstd";
import { badFile } from "../../errors.js";
import { lz4 } from "./lz4.js";
import { decoderOf } from "./messages.js";
import { RosSource, type RosFile, type RosTopic, byName, chunkSize } from "./ros-source.js";
import type { Bytes, Source } from "./source.js";

/** Bytes of the largest file without an index, which has to fit into memory. */
const MOST_WITHOUT_INDEX = 512 * 2 ** 20;
/** Bytes of such a file that are read at once. */
const PART = 4 * 2 ** 20;
const HANDLERS: DecompressHandlers = {
  lz4: (bytes, size) => lz4(bytes, chunkSize(size)),
  zstd: (bytes, size) => zstd(bytes, new Uint8Array(chunkSize(size))),
};

const seconds = (nanoseconds: bigint): number => Number(nanoseconds) / 1e9;
const nanoseconds = (time: number): bigint => BigInt(Math.round(time * 1e9));
const text = new TextDecoder();

type Channels = ReadonlyMap<number, McapTypes.TypedMcapRecords["Channel"]>;
type Schemas = ReadonlyMap<number, McapTypes.TypedMcapRecords["Schema"]>;

function topicsOf(channels: Channels, schemas: Schemas, countOf: (channel: number) => number): RosTopic[] {
  return byName(
    [...channels.values()].map(({ id, topic, schemaId, messageEncoding }) => {
      const schema = schemas.get(schemaId);
      const by = () =>
        decoderOf(messageEncoding, {
          encoding: schema?.encoding ?? "",
          definition: schema ? text.decode(schema.data) : "",
        });
      return { name: topic, type: schema?.name ?? "", count: countOf(id), by };
    }),
  );
}

async function indexed(bytes: Bytes): Promise<RosFile | undefined> {
  const readable = {
    size: async () => BigInt(bytes.size),
    read: async (offset: bigint, size: bigint) => bytes.read(Number(offset), Number(size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: HANDLERS });
  const { chunkIndexes, statistics, channelsById, schemasById } = reader;
  // The index lists no messages outside of chunks, and a writer may leave the index of the chunks out.
  const isEmpty = statistics?.messageCount === 0n;
  if (!isEmpty && chunkIndexes.every(({ messageIndexLength }) => messageIndexLength === 0n)) return undefined;
  const starts = chunkIndexes.map(({ messageStartTime }) => messageStartTime);
  const ends = chunkIndexes.map(({ messageEndTime }) => messageEndTime);
  const least = starts.reduce((a, b) => (b < a ? b : a), starts[0] ?? 0n);
  const last = ends.reduce((a, b) => (b > a ? b : a), ends[0] ?? 0n);
  const topics = topicsOf(channelsById, schemasById, (id) =>
    Number(statistics?.channelMessageCounts.get(id) ?? (statistics ? 0n : 1n)),
  );
  async function* messages(names: readonly string[], from: number, until: number) {
    const range = { startTime: nanoseconds(from), endTime: nanoseconds(until) };
    // A double cannot represent a Unix time to the nanosecond; rounding must not exclude the first and the last message.
    if (range.startTime < least || from <= seconds(least)) range.startTime = least;
    if (range.endTime > last || until >= seconds(last)) range.endTime = last;
    for await (const { channelId, logTime, data } of reader.readMessages({ topics: names, ...range }))
      yield { topic: channelsById.get(channelId)?.topic ?? "", time: seconds(logTime), bytes: data };
  }
  return { format: "MCAP", topics, span: [seconds(least), seconds(last)], messages };
}

interface Logged {
  channel: number;
  time: number;
  bytes: Uint8Array;
}

/** Takes the records that are complete; returns false if damaged data follow. */
function take(
  reader: McapStreamReader,
  channels: Map<number, McapTypes.TypedMcapRecords["Channel"]>,
  schemas: Map<number, McapTypes.TypedMcapRecords["Schema"]>,
  all: Logged[],
): boolean {
  try {
    for (let record = reader.nextRecord(); record !== undefined; record = reader.nextRecord()) {
      if (record.type === "Channel") channels.set(record.id, record);
      else if (record.type === "Schema") schemas.set(record.id, record);
      else if (record.type === "Message")
        all.push({ channel: record.channelId, time: seconds(record.logTime), bytes: record.data.slice() });
    }
    return true;
  } catch (error) {
    if (all.length === 0) throw error;
    return false;
  }
}

/** Reads all of a file without an index, such as a recording that was interrupted. */
async function streamed(bytes: Bytes): Promise<RosFile> {
  if (bytes.size > MOST_WITHOUT_INDEX)
    throw badFile(
      `this MCAP has no index, as its recording was interrupted, and its ${bytes.size} bytes are too many to read without one; \`mcap recover FILE -o OUT\` of the MCAP command line repairs it`,
    );
  const reader = new McapStreamReader({ decompressHandlers: HANDLERS });
  const channels = new Map<number, McapTypes.TypedMcapRecords["Channel"]>();
  const schemas = new Map<number, McapTypes.TypedMcapRecords["Schema"]>();
  const all: Logged[] = [];
  for (let at = 0; at < bytes.size; at += PART) {
    reader.append(await bytes.read(at, Math.min(PART, bytes.size - at)));
    if (!take(reader, channels, schemas, all)) break;
  }
  all.sort((a, b) => a.time - b.time);
  const counts = new Map<number, number>();
  for (const { channel } of all) counts.set(channel, (counts.get(channel) ?? 0) + 1);
  async function* messages(names: readonly string[], from: number, until: number) {
    for (const { channel, time, bytes } of all) {
      const topic = channels.get(channel)?.topic ?? "";
      if (time >= from && time <= until && names.includes(topic)) yield { topic, time, bytes };
    }
  }
  const span: [number, number] = [all[0]?.time ?? 0, all.at(-1)?.time ?? 0];
  return {
    format: "MCAP without an index",
    topics: topicsOf(channels, schemas, (id) => counts.get(id) ?? 0),
    span,
    messages,
  };
}

export async function openMcap(bytes: Bytes): Promise<Source> {
  let file: RosFile | undefined;
  try {
    file = await indexed(bytes);
  } catch {
    // The end of the file is damaged; the records before it may be sound.
  }
  file ??= await streamed(bytes);
  if (file.topics.length === 0)
    throw badFile("this MCAP holds no messages, or is damaged or cut off before the first one");
  return new RosSource(file);
}
