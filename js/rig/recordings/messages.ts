/**
 * Messages of ROS 1 and ROS 2 as plain objects, decoded by the definitions in the recording.
 *
 * Messages of ROS 1 are decoded here: @foxglove/rosmsg-serialization compiles a reader by `new Function`, which the page's policy forbids.
 */
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { badFile, reasonOf } from "../../errors.js";

/** The members of a message by their names. */
export type Message = Record<string, unknown>;
export type Decoder = (bytes: Uint8Array) => Message;

/** The definition of a type, as @foxglove/message-definition declares it. */
type Definition = ReturnType<typeof parse>[number];
type Field = Definition["definitions"][number];

const text = new TextDecoder();

const SIZES: Record<string, number> = {
  bool: 1,
  int8: 1,
  uint8: 1,
  int16: 2,
  uint16: 2,
  int32: 4,
  uint32: 4,
  float32: 4,
  int64: 8,
  uint64: 8,
  float64: 8,
};

/** Walks over the bytes of one ROS 1 message: little-endian, no padding, a count before lists and strings. */
class Ros1Reader {
  readonly #bytes: Uint8Array;
  readonly #view: DataView;
  readonly #types: Map<string, Field[]>;
  #at = 0;

  constructor(bytes: Uint8Array, types: Map<string, Field[]>) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#types = types;
  }

  object(fields: readonly Field[]): Message {
    const found: Message = {};
    for (const field of fields) if (!field.isConstant) found[field.name] = this.#field(field);
    return found;
  }

  #field({ type, isArray, isComplex, arrayLength }: Field): unknown {
    if (!isArray) return this.#value(type, isComplex);
    const count = arrayLength ?? this.#number("uint32");
    if (type === "uint8" || type === "int8") return this.#take(count);
    const size = SIZES[type] ?? 1;
    if (count * size > this.#bytes.length - this.#at) throw new RangeError("a list is longer than its message");
    return Array.from({ length: count }, () => this.#value(type, isComplex));
  }

  #value(type: string, isComplex: boolean | undefined): unknown {
    if (isComplex) return this.object(this.#types.get(type) ?? []);
    if (type === "string") return text.decode(this.#take(this.#number("uint32")));
    if (type === "time" || type === "duration") return { sec: this.#number("uint32"), nanosec: this.#number("uint32") };
    return this.#number(type);
  }

  #take(length: number): Uint8Array {
    if (length > this.#bytes.length - this.#at) throw new RangeError("a string or an image is longer than its message");
    this.#at += length;
    return this.#bytes.subarray(this.#at - length, this.#at);
  }

  #number(type: string): number {
    const [view, at] = [this.#view, this.#at];
    this.#at += SIZES[type] ?? 0;
    switch (type) {
      case "bool":
      case "uint8":
        return view.getUint8(at);
      case "int8":
        return view.getInt8(at);
      case "int16":
        return view.getInt16(at, true);
      case "uint16":
        return view.getUint16(at, true);
      case "int32":
        return view.getInt32(at, true);
      case "uint32":
        return view.getUint32(at, true);
      case "float32":
        return view.getFloat32(at, true);
      case "float64":
        return view.getFloat64(at, true);
      case "int64":
        return Number(view.getBigInt64(at, true));
      case "uint64":
        return Number(view.getBigUint64(at, true));
      default:
        throw badFile(`its messages have members of the unknown type ${type}`);
    }
  }
}

function ros1(definition: string): Decoder {
  const types = parse(definition);
  const byName = new Map(types.flatMap(({ name, definitions }) => (name === undefined ? [] : [[name, definitions]])));
  const root = types.find(({ name }) => name === undefined)?.definitions ?? types[0]?.definitions ?? [];
  return (bytes) => new Ros1Reader(bytes, byName).object(root);
}

function ros2(definition: string): Decoder {
  const reader = new MessageReader<Message>(parse(definition, { ros2: true }));
  return (bytes) => reader.readMessage(bytes);
}

/** The decoder of messages of an encoding ("ros1", "cdr"), or the reason why it is not supported. */
export function decoderOf(
  encoding: string,
  schema: { encoding: string; definition: string },
): { decoder: Decoder } | { unread: string } {
  const [by, language] = [encoding.toLowerCase(), schema.encoding.toLowerCase()];
  const isRos1 = by === "ros1" && (language === "ros1msg" || language === "");
  const isRos2 = by === "cdr" && (language === "ros2msg" || language === "");
  if (!isRos1 && !isRos2)
    return {
      unread: `its messages are encoded as ${encoding || "an unnamed encoding"} (${schema.encoding || "no schema"}); ROS 1 and ROS 2 (CDR) are read`,
    };
  if (schema.definition.trim() === "") return { unread: "the recording has no definition of its messages" };
  try {
    return { decoder: isRos1 ? ros1(schema.definition) : ros2(schema.definition) };
  } catch (error) {
    return {
      unread: `the definition of its messages is damaged (${reasonOf(error)})`,
    };
  }
}

export const isMessage = (value: unknown): value is Message => typeof value === "object" && value !== null;
/** A member that is an object, or an empty one. */
export const inner = (message: Message, name: string): Message => {
  const value = message[name];
  return isMessage(value) ? value : {};
};
export const numberIn = (message: Message, ...names: string[]): number => {
  for (const name of names) {
    const value = message[name];
    if (typeof value === "number") return value;
    if (typeof value === "boolean") return Number(value);
    if (typeof value === "bigint") return Number(value);
  }
  return NaN;
};
export const textIn = (message: Message, name: string): string => {
  const value = message[name];
  return typeof value === "string" ? value : "";
};
/** A list of numbers under one of several names: ROS 1 has D, K, P; ROS 2 has d, k, p. */
export const numbersIn = (message: Message, ...names: string[]): number[] => {
  for (const name of names) {
    const value = message[name];
    if (Array.isArray(value) || ArrayBuffer.isView(value)) return Array.from(value as ArrayLike<number>, Number);
  }
  return [];
};
/** Bytes under a name, without a copy. */
export const bytesIn = (message: Message, name: string): Uint8Array => {
  const value = message[name];
  if (value instanceof Uint8Array) return value;
  if (ArrayBuffer.isView(value)) return new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  return Uint8Array.from(Array.isArray(value) ? value : []);
};
/** Seconds of a header's stamp; undefined without one, or if the driver left it at zero. */
export const stampOf = (message: Message): number | undefined => {
  const stamp = inner(inner(message, "header"), "stamp");
  return (numberIn(stamp, "sec") || 0) + (numberIn(stamp, "nanosec", "nsec") || 0) * 1e-9 || undefined;
};
/** The frame of a header. ROS 1 wrote a slash before the names of frames; tf2 does not. */
export const frameOf = (message: Message): string => textIn(inner(message, "header"), "frame_id").replace(/^\/+/, "");
