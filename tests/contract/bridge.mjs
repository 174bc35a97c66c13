// A foxglove_bridge for tests: a robot's driver behind @foxglove/ws-protocol's server. Latched messages are sent to each new subscriber.
import protocol from "@foxglove/ws-protocol";
import { WebSocketServer } from "ws";
import { definitionOf, encoded } from "./recordings.mjs";

/** Interval between pictures, milliseconds. */
const EVERY = 60;

/** Serves the topics of `views` (see `driver`); the messages of the present view are sent repeatedly. */
export async function bridge(views, { port = 0, generation = "ros2" } = {}) {
  const server = new protocol.FoxgloveServer({ name: "test robot" });
  const sockets = new WebSocketServer({
    port,
    host: "127.0.0.1",
    handleProtocols: (all) => server.handleProtocols(all),
  });
  sockets.on("connection", (socket, request) => server.handleConnection(socket, request.socket.remoteAddress ?? ""));
  await new Promise((ready) => sockets.once("listening", ready));
  const channels = new Map();
  for (const { topic, type } of views[0])
    if (!channels.has(topic))
      channels.set(
        topic,
        server.addChannel({
          topic,
          encoding: generation === "ros2" ? "cdr" : "ros1",
          schemaName: generation === "ros2" ? type.replace("/", "/msg/") : type,
          schema: definitionOf(type, generation),
        }),
      );
  const listening = new Set();
  const state = { view: 0 };
  const stamped = (message) => {
    const now = Date.now() / 1000;
    const stamp = { sec: Math.floor(now), nanosec: Math.round((now % 1) * 1e9) };
    return message.header ? { ...message, header: { ...message.header, stamp } } : message;
  };
  const send = ({ topic, type, message }) =>
    server.sendMessage(
      channels.get(topic),
      BigInt(Date.now()) * 1_000_000n,
      encoded(type, stamped(message), generation),
    );
  const now = () => views[Math.min(state.view, views.length - 1)];
  server.on("subscribe", (channel) => {
    listening.add(channel);
    for (const each of now()) if (channels.get(each.topic) === channel) send(each);
  });
  server.on("unsubscribe", (channel) => listening.delete(channel));
  const timer = setInterval(() => {
    for (const each of now()) if (each.topic !== "/tf_static" && listening.has(channels.get(each.topic))) send(each);
  }, EVERY);
  return {
    address: `ws://127.0.0.1:${sockets.address().port}`,
    port: sockets.address().port,
    /** The topics that have a subscriber. */
    listening: () => [...channels].filter(([, id]) => listening.has(id)).map(([topic]) => topic),
    /** Switches to another scene. */
    turn: (view) => (state.view = view),
    close: () => {
      clearInterval(timer);
      for (const socket of sockets.clients) socket.terminate();
      return new Promise((done) => sockets.close(done));
    },
  };
}
