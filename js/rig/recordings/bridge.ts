/**
 * A connection to a foxglove_bridge over a WebSocket: the server advertises topics with the definitions of their messages, the client
 * subscribes, and messages follow as bytes. https://github.com/foxglove/ws-protocol
 *
 * The client on npm, @foxglove/ws-protocol, has no licence; only this much of the protocol is needed.
 */
import { BimodalError } from "../../errors.js";
import { decoderOf, type Message } from "./messages.js";
import type { RosTopic } from "./ros-source.js";

/** Subprotocols of the bridge since its version 3, and of earlier versions. */
const PROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/** Opcode of a binary frame that carries a message. */
const MESSAGE_DATA = 1;
/** Bytes before the message: opcode, subscription (4), time in nanoseconds (8). */
const HEAD = 13;
/** Milliseconds in which a server has to answer. */
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
  /** The name that the server gives. */
  name = "";
  readonly #socket: WebSocket;
  readonly #channels = new Map<number, Channel>();
  readonly #subscriptions = new Map<
    number,
    { channel: Channel; listener: Listener; onError: (error: unknown) => void }
  >();
  /** Fulfilled with the reason once the connection has ended. */
  readonly closed: Promise<string>;
  /** Fulfilled once the server has advertised its topics. */
  readonly advertised: Promise<void>;
  #onAdvertised = () => {};
  #next = 1;
  #isOpen = true;

  constructor(address: string, socket: WebSocket) {
    this.address = address;
    this.#socket = socket;
    socket.addEventListener("message", ({ data }) => this.#receive(data));
    this.advertised = new Promise((found) => (this.#onAdvertised = found));
    this.closed = new Promise((end) => {
      const close = (reason: string) => {
        this.#isOpen = false;
        end(reason);
      };
      socket.addEventListener("close", ({ code, reason }) => close(reason || `the connection was closed (${code})`));
      // If a browser's policy forbids the address, it reports an error, but no end.
      socket.addEventListener("error", () =>
        setTimeout(() => socket.readyState === socket.CLOSED && close("the connection was refused")),
      );
    });
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
    let received: unknown;
    try {
      received = JSON.parse(data);
    } catch {
      return;
    }
    if (!isObject(received)) return;
    const { op, name, channels, channelIds } = received;
    if (op === "serverInfo") this.name = textOf(name);
    if (op === "advertise" && Array.isArray(channels)) {
      for (const each of channels) this.#add(each);
      this.#onAdvertised();
    }
    if (op === "unadvertise" && Array.isArray(channelIds))
      for (const id of channelIds) this.#channels.delete(Number(id));
  }

  #add(channel: unknown): void {
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

  /** Subscribes to topics; the function that it returns ends the subscription. */
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

/** The URL of an address: "robot:8765" is ws://robot:8765. */
function addressOf(written: string): string {
  const text = written.trim();
  const whole = /^\w+:\/\//.test(text) ? text.replace(/^http/i, "ws") : `ws://${text}`;
  let url: URL | undefined;
  try {
    url = new URL(whole);
  } catch {
    // The error is reported below, as for all addresses that are not those of a WebSocket.
  }
  if (!url || !/^wss?:$/.test(url.protocol) || url.hostname === "")
    throw noConnection(text.slice(0, 100), "it is not the address of a bridge; write it like ws://localhost:8765");
  return url.href;
}

const REFUSED =
  "the browser refused the address. A page that was loaded by https may only open wss://, or ws:// on localhost: load the page by http, or serve the bridge with TLS. The content security policy of the page may forbid WebSockets as well";

function socketOf(address: string): WebSocket {
  if (typeof WebSocket === "undefined")
    throw noConnection(address, "this environment has no WebSocket; browsers have one, and Node.js since version 22");
  try {
    const socket = new WebSocket(address, PROTOCOLS);
    socket.binaryType = "arraybuffer";
    return socket;
  } catch (error) {
    throw noConnection(address, REFUSED, error);
  }
}

/** Connects and waits for the topics, which the server sends at once. A server without topics sends only its name. */
export async function connect(written: string): Promise<Bridge> {
  const address = addressOf(written);
  const socket = socketOf(address);
  const bridge = new Bridge(address, socket);
  let timer: ReturnType<typeof setTimeout> | undefined;
  const late = new Promise<void>((end) => (timer = setTimeout(end, PATIENCE)));
  const isBridge = await Promise.race([
    bridge.advertised.then(() => true),
    bridge.closed.then(() => false),
    late.then(() => bridge.name !== ""),
  ]);
  clearTimeout(timer);
  if (isBridge) return bridge;
  const isOpen = bridge.isOpen;
  bridge.close();
  throw noConnection(
    address,
    isOpen
      ? `the server does not answer as a foxglove_bridge within ${PATIENCE / 1000} s; check the address`
      : "no foxglove_bridge can be reached there. Is it running (ros2 launch foxglove_bridge foxglove_bridge_launch.xml), and is its port open?",
  );
}
