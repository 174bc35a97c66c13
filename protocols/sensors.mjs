// Depth with the flaws of sensors, refined at the known pose: quantised, noisy, laterally blurred.
import { FROM_ANYWHERE } from "./scenes.mjs";

/** Three of twenty frames; the truth is the median of all twenty. */
const FRAMES = [1, 7, 14];
/** Objects of `mit_berkeley`: constants were set on the first half; the second half judges them. The same holds for scans. */
const OBJECTS = [
  ...["raccoon", "squirrel", "deer", "sun", "paper1"].map((object) => ({ object, half: "tuned" })),
  ...["frog2", "turtle", "panther", "cup1", "teabag1"].map((object) => ({ object, half: "held out" })),
];
const SCANS = [
  { object: "bear", half: "tuned" },
  { object: "cow", half: "held out" },
];
const SIZE = 128;

const OPTIONS = { ...FROM_ANYWHERE, start: "truth", registration: "fixed", scale: 1 };

const mittenCell = (frame) => ({
  id: `sensors/mitten/${frame}`,
  kind: "mitten",
  row: { sensor: "mitten", object: `mitten, frame ${frame}`, half: "tuned" },
  frame,
  options: OPTIONS,
});

const kinectCell = ({ object, half }, image) => ({
  id: `sensors/kinect/${object}/${image}`,
  kind: "kinect",
  row: { sensor: `kinect, ${image === "render" ? "render" : "photograph"}`, object, half },
  scene: { surface: object, light: "A", size: SIZE, angles: {} },
  photograph: image === "render" ? null : image,
  options: OPTIONS,
});

const scanCell = ({ object, half }, lightName) => ({
  id: `sensors/scan/${object}/${lightName}`,
  kind: "scan",
  row: { sensor: "scan, render", object: `${object}, light ${lightName}`, half },
  scan: object,
  lightName,
  options: OPTIONS,
});

export const sensors = {
  name: "sensors",
  title:
    "Sensors: depth refined at the known pose, light estimated; median error before and after, millimetres (mitten) or pixels",
  notes: [
    "mitten: one frame against the median of twenty, which has steps itself and is smoothed by 1.5 pixels",
    "kinect: 128x128, object 0.2 m wide at 0.8 m, disparity 580 x 0.075 / z rounded to 1/8 pixel; photograph, or light A",
    "blur: the Gaussian blur of the measured depth with the smallest error; the truth chooses its sigma, given in brackets",
    "scan: bear and cow of DiLiGenT, noise of 0.7 pixel lengths smoothed sideways by 0.8 pixels, then steps of 0.8",
  ],
  cells: ({ complete }, quick) => {
    if (!complete) return [];
    if (quick) return [kinectCell(OBJECTS[0], "lab_diffuse"), scanCell(SCANS[0], "A")];
    return [
      ...FRAMES.map(mittenCell),
      ...["lab_diffuse", "render"].flatMap((image) => OBJECTS.map((object) => kinectCell(object, image))),
      ...SCANS.flatMap((scan) => ["A", "B"].map((lightName) => scanCell(scan, lightName))),
    ];
  },
};

/** Rows of a sensor, of one half or of both. */
export const ofSensor = (rows, sensor, half) =>
  rows.filter((row) => row.sensor === sensor && (!half || row.half === half));
