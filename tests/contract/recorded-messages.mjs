// Messages of a depth camera in front of three rendered scenes, a quarter of their size; scripts/reference/recording.py writes them as bags.
//   node tests/contract/recorded-messages.mjs > target/messages.json      (needs pkg/: npm run build)
import { sampleRig } from "../../pkg/index.js";
import { definitionOf, driver, encoded } from "./recordings.mjs";

/** Pixel x of the small picture lies at pixel 4 x + 1 of the large one: its colour is the mean of the 3x3 pixels there, its depth that of this one pixel. */
const STEP = 4;
const OFFSET = 1;
const smaller = ({ fx, fy, cx, cy, distortion }) => ({
  fx: fx / STEP,
  fy: fy / STEP,
  cx: (cx - OFFSET) / STEP,
  cy: (cy - OFFSET) / STEP,
  distortion,
});

function smallDepth({ width, height, data, camera, unit }) {
  const [w, h] = [Math.floor(width / STEP), Math.floor(height / STEP)];
  const at = (x, y) => data[(STEP * y + OFFSET) * width + STEP * x + OFFSET];
  const small = Uint16Array.from({ length: w * h }, (_, pixel) => at(pixel % w, Math.floor(pixel / w)));
  return { width: w, height: h, data: small, camera: smaller(camera), unit };
}

function smallColour({ width, height, data, camera }) {
  const [w, h] = [Math.floor(width / STEP), Math.floor(height / STEP)];
  const small = new Uint8Array(4 * w * h).fill(255);
  for (let pixel = 0; pixel < w * h; pixel++)
    for (let channel = 0; channel < 3; channel++) {
      let sum = 0;
      for (let i = 0; i < 9; i++) {
        const x = STEP * (pixel % w) + OFFSET + (i % 3) - 1;
        const y = STEP * Math.floor(pixel / w) + OFFSET + Math.floor(i / 3) - 1;
        sum += data[4 * (y * width + x) + channel];
      }
      small[4 * pixel + channel] = Math.round(sum / 9);
    }
  return { width: w, height: h, data: small, camera: smaller(camera) };
}

/** Three small frames of one rig, and the motion between its cameras. */
export async function smallFrames() {
  const frames = [];
  for (let frame = 0; frame < 3; frame++) {
    const { image, depth, pose } = await sampleRig({ kind: "boxes", seed: 2, frame });
    frames.push({ image: smallColour(image), depth: smallDepth(depth), pose });
  }
  return frames;
}

if (import.meta.filename === process.argv[1]) {
  const frames = await smallFrames();
  const messages = driver(frames, frames[0].pose, { compress: true });
  const plain = messages.map(({ topic, type, time, message }) => ({
    topic,
    type,
    nanoseconds: String(Math.round(time * 1e6) * 1000),
    definition: definitionOf(type, "ros1"),
    bytes: Buffer.from(encoded(type, message, "ros1")).toString("base64"),
  }));
  console.log(JSON.stringify(plain));
}
