// The cameras of a robot behind a server of @foxglove/ws-protocol: topics, changing views, and a lost connection.
import assert from "node:assert/strict";
import { test } from "node:test";
import { WebSocket } from "ws";
import { connectRobot } from "../../pkg/rig-recordings.js";
import { bridge } from "./bridge.mjs";
import { CAMERA, K, POSE, frame } from "./recorded.mjs";
import { FRAMES, driver } from "./recordings.mjs";
import { close, translation } from "./rig-support.mjs";

// Node.js has a WebSocket only from version 22.
globalThis.WebSocket = WebSocket;

/** The messages that the robot sends for each scene. */
const views = (count) => Array.from({ length: count }, (_, index) => driver([frame(index)], POSE));

for (const generation of ["ros1", "ros2"])
  test(`a robot of ${generation} gives one view after the other, and its images are subscribed to only meanwhile`, async () => {
    const robot = await bridge(views(2), { generation });
    try {
      const found = await connectRobot(robot.address.replace("ws://", ""));
      assert.equal(found.name, "test robot");
      assert.deepEqual(found.chosen, { colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" });
      const choice = { colour: found.chosen.colour, depth: found.chosen.depth };
      const first = await found.next(choice);
      assert.deepEqual(
        first.cameras.map(({ camera }) => camera),
        [CAMERA, K],
      );
      assert.equal(first.poses[0].from, FRAMES.depth);
      close(first.poses[0].pose.translation, translation, 1e-9);
      assert.deepEqual([...first.frames[0].depth.data], [...frame(0).depth.data]);
      assert.deepEqual(
        first.warnings.filter(({ isDoubt }) => isDoubt),
        [],
      );
      const second = found.next(choice);
      robot.turn(1);
      assert.deepEqual([...(await second).frames[0].depth.data], [...frame(1).depth.data]);
      await new Promise((rested) => setTimeout(rested, 200));
      assert.deepEqual(
        robot.listening().filter((topic) => /image/.test(topic)),
        [],
      );
      found.close();
      await found.closed;
    } finally {
      await robot.close();
    }
  });

test("a lost connection and one that cannot be made are errors that name the address", async () => {
  const robot = await bridge(views(1));
  const found = await connectRobot(robot.address);
  await found.next({ colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" });
  const next = found.next({ colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" });
  const lost = assert.rejects(next, /127.0.0.1.+the connection was lost/);
  await robot.close();
  await lost;
  assert.match(await found.closed, /closed/);
  await assert.rejects(connectRobot(robot.address), /no foxglove_bridge can be reached there/);
  await assert.rejects(connectRobot("ftp://robot"), /not the address of a bridge/);
});

test("waiting for a view can be cancelled, and an unknown topic is named", async () => {
  const robot = await bridge(views(1));
  try {
    const found = await connectRobot(robot.address);
    const controller = new AbortController();
    const choice = { colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" };
    await found.next(choice);
    const next = found.next({ ...choice, signal: controller.signal });
    controller.abort();
    await assert.rejects(next, { name: "AbortError" });
    await assert.rejects(found.next({ ...choice, depth: "/none" }), /no topic \/none/);
    found.close();
  } finally {
    await robot.close();
  }
});
