/**
 * Matroska files of an Azure Kinect (k4arecorder and its wrappers): colour as JPEG or raw pixels, depth as 16-bit big-endian grey, and the
 * calibration of the device as an attachment.
 */
import { BimodalError, badFile } from "../../errors.js";
import { readJpeg } from "../formats/jpeg.js";
import { readText } from "../formats/text.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Element, Elements, elementsIn, text, unsigned } from "./ebml.js";
import { isKnown, pixels } from "./pixels.js";
import { ofPicture } from "./ros.js";
import type { Bytes, Found, Shot, Source, Track } from "./source.js";

const ID = {
  segment: 0x18538067,
  info: 0x1549a966,
  scale: 0x2ad7b1,
  tracks: 0x1654ae6b,
  track: 0xae,
  number: 0xd7,
  name: 0x536e,
  codec: 0x86,
  codecPrivate: 0x63a2,
  video: 0xe0,
  width: 0xb0,
  height: 0xba,
  attachments: 0x1941a469,
  attached: 0x61a7,
  fileName: 0x466e,
  fileData: 0x465c,
  cluster: 0x1f43b675,
  time: 0xe7,
  group: 0xa0,
  block: 0xa1,
  simple: 0xa3,
} as const;
/** Elements of a segment, each of which ends a cluster of unknown size. */
const TOP: ReadonlySet<number> = new Set([
  ID.info,
  ID.tracks,
  ID.attachments,
  ID.cluster,
  0x1254c367,
  0x1c53bb6b,
  0x114d9b74,
]);
/** Largest number of bytes before the content of a block: track number, time and flags. */
const BLOCK_HEAD = 12;
/** Largest number of blocks of a recording; an hour of three cameras has a third as many. */
const MOST_BLOCKS = 1_000_000;

interface Video {
  number: number;
  name: string;
  /** "MJPG", "b16g" and so on, or the codec id. */
  codec: string;
  width: number;
  height: number;
}

interface Block {
  track: number;
  /** Seconds. */
  time: number;
  from: number;
  length: number;
}

const NONE = new Uint8Array();

const childrenOf = (bytes: Uint8Array): Map<number, Uint8Array> =>
  new Map([...elementsIn(bytes)].map((each) => [each.id, each.bytes]));

/** A video track; tracks of Windows codecs name the codec in a BITMAPINFOHEADER. */
function videoOf(bytes: Uint8Array): Video {
  const found = childrenOf(bytes);
  const of = (id: number) => found.get(id) ?? NONE;
  const size = childrenOf(of(ID.video));
  const codec = text(of(ID.codec));
  const extra = of(ID.codecPrivate);
  const number = unsigned(of(ID.number));
  return {
    number,
    name: text(of(ID.name)) || `track ${number}`,
    codec: codec === "V_MS/VFW/FOURCC" && extra.length >= 20 ? text(extra.subarray(16, 20)) : codec,
    width: unsigned(size.get(ID.width) ?? NONE),
    height: unsigned(size.get(ID.height) ?? NONE),
  };
}

const isJpeg = ({ codec }: Video): boolean => /^(?:MJPG|V_MJPEG)$/.test(codec);
const isRead = (video: Video): boolean => video.width > 0 && (isJpeg(video) || isKnown(video.codec));

/** Reads the elements outside of the clusters, and the places of the blocks in the clusters. */
class Reader {
  readonly videos = new Map<number, Video>();
  readonly blocks: Block[] = [];
  calibration = "";
  #scale = 1e6;
  readonly #elements: Elements;

  constructor(bytes: Bytes) {
    this.#elements = new Elements(bytes);
  }

  async read(): Promise<void> {
    const { size } = this.#elements.bytes;
    for await (const element of this.#elements.children({ id: 0, from: 0, until: size }))
      if (element.id === ID.segment) await this.#segment(element);
  }

  async #segment(segment: Element): Promise<void> {
    for (let at = segment.from; at < segment.until; ) {
      const element = await this.#elements.at(at, segment.until);
      if (element === undefined) return;
      at = element.until;
      if (element.id === ID.cluster) at = await this.#cluster(element);
      else if (element.id === ID.info) this.#info(await this.#elements.content(element));
      else if (element.id === ID.tracks) this.#tracks(await this.#elements.content(element));
      else if (element.id === ID.attachments) await this.#attachments(element);
    }
  }

  #info(bytes: Uint8Array): void {
    const scale = childrenOf(bytes).get(ID.scale);
    if (scale) this.#scale = unsigned(scale);
  }

  #tracks(bytes: Uint8Array): void {
    for (const each of elementsIn(bytes)) {
      if (each.id !== ID.track) continue;
      const video = videoOf(each.bytes);
      this.videos.set(video.number, video);
    }
  }

  async #attachments(attachments: Element): Promise<void> {
    for (const each of elementsIn(await this.#elements.content(attachments))) {
      const file = childrenOf(each.bytes);
      const data = file.get(ID.fileData);
      if (each.id === ID.attached && data && /calibration.*\.json$/i.test(text(file.get(ID.fileName) ?? NONE)))
        this.calibration = text(data);
    }
  }

  /** Reads a cluster and returns where the next element of the segment begins. */
  async #cluster(cluster: Element): Promise<number> {
    let start = 0;
    for (let at = cluster.from; at < cluster.until; ) {
      const element = await this.#elements.at(at, cluster.until);
      if (element === undefined) return cluster.until;
      if (TOP.has(element.id)) return at;
      if (element.id === ID.time) start = unsigned(await this.#elements.content(element));
      else if (element.id === ID.simple) await this.#block(element, start);
      else if (element.id === ID.group)
        for await (const each of this.#elements.children(element))
          if (each.id === ID.block) await this.#block(each, start);
      at = element.until;
    }
    return cluster.until;
  }

  async #block({ from, until }: Element, start: number): Promise<void> {
    const head = await this.#elements.peek(from, Math.min(BLOCK_HEAD, until - from));
    const width = Math.clz32(head[0] ?? 0) - 23;
    if (head.length < width + 3) return;
    let track = (head[0] ?? 0) & (0xff >> width);
    for (let i = 1; i < width; i++) track = track * 256 + (head[i] ?? 0);
    const view = new DataView(head.buffer, head.byteOffset, head.byteLength);
    // A laced block holds several small frames; pictures are not laced.
    if ((view.getUint8(width + 2) & 6) !== 0 || !this.videos.has(track)) return;
    if (this.blocks.length >= MOST_BLOCKS)
      throw badFile(`it holds more than ${MOST_BLOCKS} pictures; cut it into shorter recordings`);
    const time = ((start + view.getInt16(width, false)) * this.#scale) / 1e9;
    this.blocks.push({ track, time, from: from + width + 3, length: until - from - width - 3 });
  }
}

interface Calibration {
  cameras: NamedCamera[];
  poses: NamedPose[];
  warnings: ReaderWarning[];
}

class MatroskaSource implements Source {
  readonly format = "Matroska";
  readonly tracks: Track[];
  readonly span: [number, number];
  readonly #bytes: Bytes;
  readonly #videos: Map<string, Video>;
  readonly #blocks: Block[];
  readonly #calibration: Calibration;

  constructor(bytes: Bytes, { videos, blocks }: Reader, calibration: Calibration) {
    this.#bytes = bytes;
    this.#calibration = calibration;
    this.#videos = new Map([...videos.values()].map((video) => [video.name, video]));
    this.#blocks = blocks.sort((a, b) => a.time - b.time);
    this.span = [blocks[0]?.time ?? 0, blocks.at(-1)?.time ?? 0];
    this.tracks = [...this.#videos.values()].map((video) => ({
      name: video.name,
      type: video.codec,
      kind: isRead(video) ? "picture" : "other",
      count: blocks.filter(({ track }) => track === video.number).length,
      ...(!isRead(video) && video.width > 0 && { unread: unread(video) }),
    }));
  }

  async *shots(tracks: readonly string[], from: number, until: number): AsyncIterable<Shot> {
    const wanted = new Map(
      tracks.flatMap((name) => {
        const video = this.#videos.get(name);
        return video && isRead(video) ? [[video.number, video] as const] : [];
      }),
    );
    for (const block of this.#blocks) {
      const video = wanted.get(block.track);
      if (video && block.time >= from && block.time <= until) yield this.#shot(video, block);
    }
  }

  #shot(video: Video, { time, from, length }: Block): Shot {
    const { name, codec, width, height } = video;
    const read: Shot["read"] = async (options) => {
      const data = await this.#bytes.read(from, length);
      if (isJpeg(video)) return ofPicture(await readJpeg(data), options);
      return ofPicture(pixels({ width, height, step: 0, encoding: codec, isBigEndian: false, data }), options);
    };
    const encoding = isJpeg(video) ? "jpeg" : codec;
    return {
      track: name,
      logged: time,
      taken: time,
      frame: name,
      encoding,
      width,
      height,
      bytes: length,
      read,
    };
  }

  /** The calibration has each camera in all of its modes. The size of the pictures shows which mode was used. */
  async camera({ track, width, height }: Shot): Promise<Found<NamedCamera | undefined>> {
    const isDepth = /depth|^ir$/i.test(track);
    const found = this.#calibration.cameras.find(
      (camera) => /depth/i.test(camera.name ?? "") === isDepth && camera.width === width && camera.height === height,
    );
    return { found, warnings: this.#calibration.warnings };
  }

  async poses(): Promise<Found<NamedPose[]>> {
    const { poses } = this.#calibration;
    return {
      found: poses.filter(({ from = "", to = "" }) => /depth/i.test(from) && /colou?r/i.test(to)),
      warnings: [],
    };
  }
}

const unread = ({ codec }: Video): string =>
  `its pictures are stored as "${codec.slice(0, 40)}", which is not supported; MJPG, NV12, YUY2 and b16g of an Azure Kinect are`;

/** The attached calibration. One that cannot be read is left out with a warning. */
async function calibrationOf(attached: string): Promise<Calibration> {
  const nothing: Calibration = { cameras: [], poses: [], warnings: [] };
  if (attached === "") return nothing;
  try {
    return await readText(attached, "");
  } catch (error) {
    if (!(error instanceof BimodalError)) throw error;
    return {
      ...nothing,
      warnings: [warning("file-left-out", `The attached calibration was left out: ${error.message}.`)],
    };
  }
}

export async function openMatroska(bytes: Bytes): Promise<Source> {
  const reader = new Reader(bytes);
  await reader.read();
  if (reader.blocks.length === 0)
    throw badFile("this Matroska file holds no pictures, or is cut off before the first one");
  return new MatroskaSource(bytes, reader, await calibrationOf(reader.calibration));
}
