/** Names of cameras that stand near their numbers: the object that holds a camera and its pose, and the topic of its images. */
import type { NamedCamera, NamedPose } from "../types.js";

/** Ends of a pose that name a camera, but not which one. */
const SOME_CAMERA = /^(?:cam|camera|image|img)$/i;
/** Parts of topics that do not distinguish cameras: the kind of message, and whether it was rectified. */
const MESSAGE = /\/(?:image|compressed|image_raw|image_rect|image_rect_raw|image_color|image_mono|raw)$/i;

/** If several cameras have one pose each, each pose leads to or from its camera: "lidar2cam" of CAM_FRONT leads to CAM_FRONT. */
export function ofOwnCameras(own: ReadonlyMap<NamedPose, string | undefined>): void {
  if (own.size < 2) return;
  for (const [each, camera] of own) {
    const { from, to } = each;
    if (camera === undefined || from === undefined || to === undefined || from === "world" || to === "world") continue;
    if (SOME_CAMERA.test(to)) Object.assign(each, { to: camera, name: `${camera} from ${from}` });
    else if (SOME_CAMERA.test(from)) Object.assign(each, { from: camera, name: `${to} from ${camera}` });
  }
}

/** A topic without the kind of its messages and its first slash. */
function called(topic: string): string {
  let name = topic.trim().slice(0, 80).replace(/\/+$/, "");
  while (MESSAGE.test(name)) name = name.replace(MESSAGE, "");
  return name.replace(/^\/+/, "");
}

/** Cameras that are only numbered (Kalibr's cam0), and the ends of poses, are named after the topics of their images. */
export function byTopics(topics: ReadonlyMap<string, string>, cameras: NamedCamera[], poses: NamedPose[]): void {
  const names = new Map([...topics].map(([camera, topic]) => [camera, called(topic)]));
  const isClear = new Set(names.values()).size === names.size && ![...names.values()].includes("");
  if (!isClear || [...names.keys()].some((camera) => !/^cam\d+$/i.test(camera))) return;
  const renamed = (name: string | undefined) => names.get(name ?? "") ?? name;
  for (const camera of cameras) Object.assign(camera, { name: renamed(camera.name) });
  for (const pose of poses) {
    const [from, to] = [renamed(pose.from), renamed(pose.to)];
    if (from === pose.from && to === pose.to) continue;
    Object.assign(pose, { from, to, name: `${to} from ${from}` });
  }
}
