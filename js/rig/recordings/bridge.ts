/**
 * A connection to a foxglove_bridge, by its protocol over a WebSocket: the server advertises topics with the definitions of their messages,
 * the client subscribes, and messages follow as bytes. https://github.com/foxglove/ws-protocol
 *
 * Its client in JavaScript, @foxglove/ws-protocol, comes without a licence; what is needed of it is this much.
 */
import { BimodalError } from "../../errors.js";
import { decoderOf, type Message } from "./messages.js";
import type { RosTopic } from "./ros-source.js";

/** The bridge's since version 3, and the one before. */
const PROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/** Before a message: what it is, its subscription, and when it was recorded. */
const MESSAGE_DATA = 1;
const HEAD = 13;
/** Milliseconds that a server has to answer. */
const PATIENCE = 15_000;

export const noConnection = (address: string, reason: string, cause?: unknown): BimodalError =>
  new BimodalError("unsupported", `${address}: ${reason}`, "address", cause === undefined ? {} : { cause });

interface Channel extends RosTopic {
  id: number;
}

type Listener = (topic: string, type: string, time: number, message: Message) => void;

const isObject = (value: unknown): value is Record<string, unknown> => typeof value === "object" && value !== null;
const textOf = (value: unknown): string => (typeof value === "string" ? value : "");

export class Bridge {
  readonly address: string;
  /** What the server calls itself. */
  name = "";
  readonly #socket: WebSocket;
  readonly #channels = new Map<number, Channel>();
  readonly #subscriptions = new Map<
    number,
    { channel: Channel; listener: Listener; onError: (error: unknown) => void }
  >();
  readonly closed: Promise<string>;
  #next = 1;
  #isOpen = true;

  constructor(address: string, socket: WebSocket) {
    this.address = address;
    this.#socket = socket;
    socket.addEventListener("message", ({ data }) => this.#receive(data));
    // It says nothing, and the end that follows says what there is to say.
    socket.addEventListener("error", () => {});
    this.closed = new Promise((end) =>
      socket.addEventListener("close", ({ code, reason }) => {
        this.#isOpen = false;
        end(reason || `the connection was closed (${code})`);
      }),
    );
  }

  get isOpen(): boolean {
    return this.#isOpen;
  }

  get topics(): RosTopic[] {
    return [...this.#channels.values()];
  }

  close(): void {
    this.#socket.close();
  }

  #receive(data: unknown): void {
    if (typeof data !== "string") return this.#message(data);
    let said: unknown;
    try {
      said = JSON.parse(data);
    } catch {
      return;
    }
    if (!isObject(said)) return;
    if (said.op === "serverInfo") this.name = textOf(said.name);
    if (said.op === "advertise" && Array.isArray(said.channels))
      for (const each of said.channels) this.#advertised(each);
    if (said.op === "unadvertise" && Array.isArray(said.channelIds))
      for (const id of said.channelIds) this.#channels.delete(Number(id));
  }

  #advertised(channel: unknown): void {
    if (!isObject(channel)) return;
    const encoding = textOf(channel.encoding);
    const schema = { encoding: textOf(channel.schemaEncoding), definition: textOf(channel.schema) };
    const id = Number(channel.id);
    const by = decoderOf(encoding, schema);
    this.#channels.set(id, { id, name: textOf(channel.topic), type: textOf(channel.schemaName), count: 0, by });
  }

  #message(data: unknown): void {
    if (!(data instanceof ArrayBuffer) || data.byteLength < HEAD) return;
    const view = new DataView(data);
    if (view.getUint8(0) !== MESSAGE_DATA) return;
    const subscription = this.#subscriptions.get(view.getUint32(1, true));
    if (!subscription) return;
    const { channel, listener, onError } = subscription;
    channel.count++;
    if (!("decoder" in channel.by)) return;
    try {
      const message = channel.by.decoder(new Uint8Array(data, HEAD));
      listener(channel.name, channel.type, Number(view.getBigUint64(5, true)) / 1e9, message);
    } catch (error) {
      onError(error);
    }
  }

  #send(message: object): void {
    if (this.#isOpen) this.#socket.send(JSON.stringify(message));
  }

  /** Has the messages of topics until what it gives back is called. */
  listen(topics: readonly string[], listener: Listener, onError: (error: unknown) => void = () => {}): () => void {
    const ids: number[] = [];
    for (const channel of this.#channels.values()) {
      if (!topics.includes(channel.name)) continue;
      const id = this.#next++;
      ids.push(id);
      this.#subscriptions.set(id, { channel, listener, onError });
      this.#send({ op: "subscribe", subscriptions: [{ id, channelId: channel.id }] });
    }
    return () => {
      for (const id of ids) this.#subscriptions.delete(id);
      this.#send({ op: "unsubscribe", subscriptionIds: ids });
    };
  }
}

/** The address as a browser opens it: "robot:8765" is ws://robot:8765. */
export function addressOf(written: string): string {
  const text = written.trim();
  const whole = /^\w+:\/\//.test(text) ? text.replace(/^http/i, "ws") : `ws://${text}`;
  let url: URL | undefined;
  try {
    url = new URL(whole);
  } catch {
    // Said below.
  }
  if (!url || !/^wss?:$/.test(url.protocol) || url.hostname === "")
    throw noConnection(text.slice(0, 100), "it is no address of a bridge; ws://localhost:8765 is one");
  return url.href;
}

function socketOf(address: string): WebSocket {
  if (typeof WebSocket === "undefined")
    throw noConnection(address, "there is no WebSocket here; browsers have one, and Node from version 22 on");
  try {
    const socket = new WebSocket(address, PROTOCOLS);
    socket.binaryType = "arraybuffer";
    return socket;
  } catch (error) {
    throw noConnection(
      address,
      "the browser refuses this address. A page that came by https may open wss:// alone, and ws:// on localhost; serve the page by http, or the bridge with TLS. A server's own policy may forbid it as well",
      error,
    );
  }
}

/** Connects, and waits for the topics: the server sends them at once. */
export async function connect(written: string): Promise<Bridge> {
  const address = addressOf(written);
  const socket = socketOf(address);
  const bridge = new Bridge(address, socket);
  const advertised = new Promise<void>((found) =>
    socket.addEventListener("message", ({ data }) => {
      if (typeof data === "string" && data.includes('"advertise"')) found();
    }),
  );
  const late = new Promise<"late">((end) => setTimeout(() => end("late"), PATIENCE));
  const ended = await Promise.race([advertised, late, bridge.closed]);
  if (ended === undefined) return bridge;
  if (ended === "late" && bridge.isOpen && bridge.name !== "") return bridge;
  bridge.close();
  throw noConnection(
    address,
    ended === "late"
      ? "nothing there answers as a foxglove_bridge does"
      : "no foxglove_bridge can be reached there. Is it running (ros2 launch foxglove_bridge foxglove_bridge_launch.xml), and is its port open?",
  );
}
