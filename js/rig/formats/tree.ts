/**
 * Cameras and motions in JSON, YAML, TOML and XML of any program: ROS, OpenCV, Open3D, Kalibr, RealSense, or written by hand.
 *
 * A walk over all objects recognises them by the names and shapes of their members (names.ts). Its depth and its number of objects are
 * bounded, which also bounds the aliases of YAML. A warning names each lens, size or pose that was not used.
 */
import { BimodalError, badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type RawCamera, cameraOf } from "./cameras.js";
import { grouped, withLists } from "./groups.js";
import { type FoundCamera, Leftovers, type Place, coefficientsOf } from "./leftovers.js";
import { modelIn, sharedModelIn } from "./stated.js";
import { bySensor, cameraOfMatrix, fourOf, kannala, listsOf, membersOf, sizeOf } from "./intrinsics.js";
import { lensNamed } from "./lenses.js";
import { unitInComments } from "./lengths.js";
import { MOST_FOUND } from "./limits.js";
import { type Context, contextOf } from "./context.js";
import { Motions } from "./motions.js";
import { signsOf } from "./signs.js";
import { isIntrinsics, labelled, lensNames, member, wordsOf } from "./names.js";
import { type Node, isNode, matrixOf, textOf } from "./numbers.js";
import { orbbecContext } from "./orbbec.js";
import { chained, inverseOf } from "./poses.js";
import { byTopics, ofOwnCameras } from "./sensors.js";
import { ofRegion } from "./region.js";

export interface Calibration {
  cameras: NamedCamera[];
  poses: NamedPose[];
  warnings: ReaderWarning[];
  /** Metres per stored unit of the depth maps that belong to the file. */
  depthUnit?: number;
}

const MOST_NODES = 50_000;
const MOST_MEMBERS = 200_000;
/** Largest number of members of an object that is a camera or a motion; larger objects may contain some. */
const MOST_OWN = 300;
const MOST_DEPTH = 24;

/** A list of at least this many poses is a trajectory. */
const SERIES = 3;
/** Labels of cameras that are derived from another one, for rectified or undistorted images. */
const DERIVED = /^(?:new|optimal|rectified|undistorted|original)$/;

/** Names of frames that carry several cameras, which are numbered within the frame. */
const BODY = /^(?:imu\d*|body|base|rig)$/i;
const CAMERA = /^cam(\d+)$/;

class Search {
  readonly cameras: NamedCamera[] = [];
  readonly warnings: ReaderWarning[] = [];
  readonly motions: Motions;
  readonly #found: FoundCamera[] = [];
  readonly #leftovers = new Leftovers();
  /** Lens models that objects without cameras state. */
  readonly #lenses: { place: Place; model: string }[] = [];
  /** Poses from objects that hold one camera and one pose, with the name of the camera. */
  readonly #own = new Map<NamedPose, string | undefined>();
  /** Topics of cameras by their names, where a file has both. */
  readonly #topics = new Map<string, string>();
  /** Texts for warnings about cameras whose lens is not supported. */
  readonly #unsupported: string[] = [];
  /** Models of cameras that the file names. */
  readonly models = new Set<string>();
  #nodes = 0;
  #members = 0;

  constructor(text: string) {
    this.motions = new Motions(signsOf(text), this.warnings);
  }

  /** `key` is the value's member name, `name` the name for its cameras and motions. */
  walk(value: unknown, key: string, name: string, context: Context, parent: Place | undefined): void {
    if (typeof value !== "object" || value === null) return;
    if (++this.#nodes > MOST_NODES) throw badFile(`it holds more than ${MOST_NODES} lists and objects`);
    const depth = 1 + (parent?.depth ?? -1);
    if (depth > MOST_DEPTH) throw badFile(`it is nested deeper than ${MOST_DEPTH}`);
    if (this.#found.length + this.motions.poses.length > MOST_FOUND)
      throw badFile(`it holds more than ${MOST_FOUND} cameras and poses`);
    if (Array.isArray(value)) return this.#list(value, key, name, context, { node: {}, parent, depth, isList: true });
    const called = nameIn(value as Node) ?? name;
    const keys = Object.keys(value);
    this.#members += keys.length;
    if (this.#members > MOST_MEMBERS) throw badFile(`its objects have more than ${MOST_MEMBERS} members`);
    const node = keys.length > MOST_OWN ? (value as Node) : withLists(value as Node);
    const place = { node, parent, depth };
    const inner = keys.length > MOST_OWN ? context : this.#read(place, key, called, context);
    for (const [group, members] of grouped(node, keys)) this.walk(members, group, group, context, place);
    for (const each of keys) {
      if (matrixOf(node[each]) !== undefined) continue;
      const ofWorld = /^(?:camera_?)?pose$/i.test(each) && inner.from === undefined && inner.to === undefined;
      const around = ofWorld ? { ...inner, from: "camera", to: "world" } : { ...inner, ...orbbecContext(node, each) };
      this.walk(node[each], each, nameOf(each, called), around, place);
    }
  }

  /** A list of cameras or of poses. Several poses without frames and without cameras are a trajectory. */
  #list(values: unknown[], key: string, name: string, context: Context, place: Place): void {
    if (typeof values[0] !== "object") return;
    const [cameras, poses] = [this.#found.length, this.motions.poses.length];
    for (const each of values) {
      const matrix = matrixOf(each);
      if (matrix?.values.length === 16 || matrix?.values.length === 12)
        this.motions.read({ [key]: each }, name, context, false);
      else this.walk(each, key, name, context, place);
    }
    const isSeries = values.length >= SERIES && this.#found.length === cameras;
    if (isSeries) this.motions.placeInWorld(poses);
  }

  /** Reads the cameras and motions that are members of this object; returns the context for the objects below it. */
  #read(place: Place, key: string, name: string, context: Context): Context {
    const { node } = place;
    const before = this.#found.length;
    const used = this.#cameraOf(place, key, name);
    const shared = this.#found.length > before ? undefined : sharedModelIn(node);
    if (shared !== undefined) this.#lenses.push({ place, model: shared });
    this.#leftovers.collect(place, used);
    const [first, second, ...more] = this.#found.slice(before).map(({ raw }) => raw.name);
    // OpenCV's stereo calibration: R and T carry points of camera 1 into camera 2. Other names have no such order.
    const stereo = first === "1" && second === "2" && more.length === 0 ? { from: "1", to: "2" } : {};
    const inner = contextOf(node, { ...context, ...(framesOf(node) ?? stereo) });
    const poses = this.motions.poses.length;
    this.motions.read(node, name, inner, this.#found.length > before);
    const isOne = this.#found.length === before + 1 && this.motions.poses.length === poses + 1;
    const own = this.motions.poses[poses];
    if (isOne && own !== undefined) this.#own.set(own, first);
    const topic = textOf(member(node, "rostopic"));
    if (topic !== undefined && first !== undefined && this.#found.length === before + 1) this.#topics.set(first, topic);
    return inner;
  }

  /** Adds the cameras of an object; returns the members that were used for their lenses. */
  #cameraOf(place: Place, key: string, parent: string): Set<string> {
    const { node } = place;
    const used = new Set<string>();
    const name = textOf(member(node, "cameraname", "camname", "name")) ?? (parent === "" ? undefined : parent);
    const label = isIntrinsics(key) ?? wordsOf(key).join(" ");
    const add = (raw: RawCamera, own = label) => {
      this.#found.push({ raw, label: own, place });
    };
    const model = textOf(member(node, "cameramodel", "modeltype", "cammodel"));
    if (model !== undefined) this.models.add(model);
    const named = membersOf(node, name) ?? kannala(node) ?? listsOf(node) ?? bySensor(node, this.warnings);
    if (named !== undefined) {
      add({ name, ...this.#rest(node, "", used), ...named });
      return used;
    }
    const four = fourOf(node, name);
    if (four !== undefined) {
      add({ name, ...four, ...this.#rest(node, "", used) });
      return used;
    }
    const matrices = Object.keys(node).flatMap((each) => {
      const own = isIntrinsics(each);
      return own === undefined ? [] : [{ each, own }];
    });
    const isDerived = matrices.some(({ own }) => !DERIVED.test(own));
    for (const { each, own } of matrices) {
      if (isDerived && DERIVED.test(own)) continue;
      const found = cameraOfMatrix(node, each, own);
      const called = own === "" || own === "cam" || own === "camera" ? name : own;
      if (found !== undefined) add({ name: called, ...found, ...this.#rest(node, own, used) }, own);
    }
    if (!this.#found.some(({ place: own }) => own.node === node)) this.#nameUnsupported(node, name);
    return used;
  }

  /** Warns of a camera whose intrinsics belong to an unsupported lens, if the file holds something else as well. */
  #nameUnsupported(node: Node, name: string | undefined): void {
    const stated = modelIn(node);
    const isCamera = member(node, "intrinsics", "intrinsic", "projectionparameters", "mirrorparameters") !== undefined;
    if (!isCamera || stated === undefined || lensNamed(stated.model).family !== "other") return;
    const of = name === undefined ? "A camera" : `The camera "${name}"`;
    const { meaning } = lensNamed(stated.model);
    this.#unsupported.push(
      `${of} was left out: its lens model "${stated.model}"${meaning === undefined ? "" : ` (${meaning})`} is not supported; Brown's and Kannala-Brandt's are.`,
    );
  }

  /** Distortion, model and size of the camera with this label. */
  #rest(node: Node, label: string, used: Set<string>): Omit<RawCamera, "name" | "focal" | "centre" | "skew"> {
    const lens = labelled(node, lensNames, label);
    const written = lens?.value ?? member(node, "distk1k2p1p2k3");
    const model = modelIn(node);
    const listed = isNode(written) && written.data === undefined ? undefined : matrixOf(written)?.values;
    const size = sizeOf(node, label);
    if (listed !== undefined) {
      for (const key of Object.keys(node)) if (node[key] === written) used.add(key);
      return { distortion: listed, ...model, ...size };
    }
    if (written !== undefined && !isNode(written) && !isEmpty(written) && typeof written !== "string")
      throw badFile("its distortion contains something other than numbers");
    const isNone = written !== undefined && isEmpty(written);
    return { distortion: isNone ? [] : undefined, ...coefficientsOf(node), ...model, ...size };
  }

  /** The lens model that the objects around a camera state, or else the only one that the file states. */
  #sharedModel(place: Place): string | undefined {
    for (let each: Place | undefined = place; each !== undefined; each = each.parent)
      for (const { place: at, model } of this.#lenses) if (at.node === each.node) return model;
    const [only, ...more] = new Set(this.#lenses.map(({ model }) => model));
    return more.length === 0 ? only : undefined;
  }

  /** Adds the cameras; one that cannot be read is left out with a warning if the file holds something else. */
  #check(): void {
    let reason: BimodalError | undefined;
    // Cameras without names in a list are numbered.
    const isListed = ({ place, raw }: FoundCamera) => raw.name !== undefined && place.parent?.isList === true;
    const listed = this.#found.filter(isListed);
    const alike = listed.filter(({ raw }) => listed.some((other) => other.raw !== raw && other.raw.name === raw.name));
    const called = alike.map(({ raw, place }) => ({
      raw,
      own: nameIn(place.node) ?? member(place.node, "name", "cameraname"),
    }));
    for (const [index, { raw, own }] of called.entries()) if (own === undefined) raw.name = `${raw.name} ${index}`;
    for (const { raw, place } of this.#found)
      try {
        this.cameras.push(cameraOf(ofRegion(raw, place.node), this.warnings));
      } catch (error) {
        if (!(error instanceof BimodalError)) throw error;
        reason ??= error;
        const of = raw.name === undefined ? "A camera" : `The camera "${raw.name}"`;
        this.warnings.push(warning("camera-left-out", `${of} was left out: ${error.message}.`));
      }
    if (this.cameras.length + this.motions.poses.length > 0)
      for (const message of this.#unsupported) this.warnings.push(warning("camera-left-out", message));
    if (reason !== undefined && this.cameras.length + this.motions.poses.length === 0) throw reason;
  }

  /** Checks cameras and poses once the whole file has been read. */
  finish(): void {
    this.#leftovers.assign(this.#found, this.warnings);
    for (const { raw, place } of this.#found) raw.model ??= this.#sharedModel(place);
    this.#check();
    this.motions.finish(this.cameras, [...this.#own.keys()]);
    chain(this.motions.poses);
    ofOwnCameras(this.#own);
    byTopics(this.#topics, this.cameras, this.motions.poses);
  }
}

/** Adds the pose from each camera to the next one if the file relates both, in either direction, to the same inertial unit or body. */
function chain(poses: NamedPose[]): void {
  /** The poses of cameras in the frame of the body, by the camera's name. */
  const places = new Map<string, { body: string; pose: NamedPose["pose"] }>();
  for (const { from = "", to = "", pose } of poses) {
    if (BODY.test(from) && CAMERA.test(to)) places.set(to, { body: from, pose: inverseOf(pose) });
    if (BODY.test(to) && CAMERA.test(from)) places.set(from, { body: to, pose });
  }
  for (const [to, place] of places) {
    const from = `cam${Number(CAMERA.exec(to)?.[1]) - 1}`;
    const before = places.get(from);
    if (before?.body !== place.body || poses.some((other) => other.from === from && other.to === to)) continue;
    poses.unshift({ ...{ name: `${to} from ${from}`, from, to }, pose: chained(inverseOf(place.pose), before.pose) });
  }
}

/** Names of the source and the target frame of a motion. */
const ENDS = [
  ["from", "to"],
  ["fromframe", "toframe"],
  ["source", "target"],
  ["sourceframe", "targetframe"],
  ["child", "parent"],
  ["childlink", "parentlink"],
  ["sensor", "reference"],
  ["sensorframe", "referenceframe"],
  ["frame", "base"],
  ["sensorname", "targetsensorname"],
] as const;

/** Whether an object has a rotation or a matrix of a motion. */
const isTransform = (node: Node): boolean =>
  member(node, "rotation", "orientation", "quaternion") !== undefined ||
  Object.values(node).some((value) => [12, 16].includes(matrixOf(value)?.values.length ?? 0));

/** The frames of a motion. ROS's transform carries points of the child frame into the parent, OpenCalib's from a sensor to its target. */
function framesOf(node: Node): Context | undefined {
  const child = textOf(member(node, "childframeid", "childframe"));
  const header = member(node, "header");
  const parent = textOf(member(isNode(header) ? header : node, "frameid", "parentframe"));
  if (child !== undefined) return { from: child, ...(parent !== undefined && { to: parent }) };
  for (const [from, to] of ENDS) {
    // Objects other than transforms may also have parents.
    if (from === "child" && !isTransform(node)) continue;
    const ends = [textOf(member(node, from)), textOf(member(node, to))];
    if (ends[0] !== undefined && ends[1] !== undefined && ends[0] !== ends[1]) return { from: ends[0], to: ends[1] };
  }
  // A pose beside an image's file name is the pose from which that image was taken.
  const picture = textOf(member(node, "filepath", "imagepath", "imgpath", "imagefile", "imgname", "imagename"));
  if (picture !== undefined) return { from: "camera", to: "world" };
  return undefined;
}

const SIDE = /^(?:colou?r|rgb|depth|ir|infra(?:red)?[_ ]?\d?)$/i;

/** The name of the stream or the sensor that an object belongs to. */
function nameIn(node: Node): string | undefined {
  const type = textOf(member(node, "type", "streamtype", "kind"));
  return textOf(member(node, "stream", "streamname", "sensor")) ?? (SIDE.test(type ?? "") ? type : undefined);
}

/** The name for a member's cameras and poses: the parent's name if the member's is generic. */
const nameOf = (key: string, parent: string): string => {
  if (/^(transforms?|intrinsics?|pose|param|opencv_storage|launch|parameters|ros__parameters|nodes)$/.test(key))
    return parent;
  // A repeated name is allowed, because a camera may have intrinsics for several sizes.
  return parent !== "" && /^\d{2,5}[xX_]\d{2,5}(?:[@_]\d+)?$/.test(key) ? `${parent} ${key}` : key;
};

const isEmpty = (value: unknown): boolean =>
  value === null || value === "" || (Array.isArray(value) && value.length === 0);

/** `text` is the text of the file, whose comments and product names are used as well. */
export function searchTree(value: unknown, text = ""): Calibration {
  const search = new Search(text);
  const unit = unitInComments(text);
  search.walk(value, "", "", unit === undefined ? {} : { unit }, undefined);
  search.finish();
  const { cameras, warnings, models, motions } = search;
  const [model] = models;
  if (cameras.length + motions.poses.length === 0 && model !== undefined)
    throw badFile(
      `its camera has the model "${model.slice(0, 40)}" and no intrinsics that can be read; pinhole cameras with Brown's or Kannala-Brandt's lenses are supported`,
    );
  const projection = warnings.find(({ isProjection }) => isProjection === true);
  if (cameras.length + motions.poses.length === 0 && projection !== undefined)
    throw badFile(`its ${projection.message.replace(/\.$/, "")}`);
  return { cameras, poses: motions.poses, warnings };
}
