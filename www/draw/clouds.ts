/**
 * Both surfaces in the colour view's frame, which the visitor can rotate. Loaded when first visible, because three.js is larger than
 * everything else.
 */

import { Matrix4, OrthographicCamera, Quaternion, Sphere, TOUCH, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Pose } from "../../pkg/index.js";
import type { Side, Surface } from "../engine/protocol";
import { ink, make, nextTask } from "../dom";
import type { Asked } from "./probe";
import { type CloudsHooks, type Renderer, rendererFor } from "./renderer";
import type { Change, PinnedSurfaces } from "./stage";

/** Milliseconds in which the depth map moves from one pose to the next. */
const SWING = 220;

const SIDES = ["image", "depth"] as const;
/** The largest distance, in CSS pixels, at which the pointer selects a point. */
const REACH = 10;
/** A point that is nearer by a tenth of the drawn depth is preferred to one that is nearer on the screen. */
const IN_FRONT = 5;

const still = matchMedia("(prefers-reduced-motion: reduce)");
/** Share of their radius by which surfaces move off the centre before the view follows; iterations move them less. */
const LEFT_THE_MIDDLE = 0.3;
/** Ratio of sizes beyond which a pinned run's object counts as having another resolution. */
const OTHER_SIZE = 1.5;
/**
 * Largest reach of the drawn points in half windows, and their reach after the view has made room. The difference keeps the view from
 * following every step of a growing object.
 */
const EDGE = 0.98;
const ROOM = 1.08;
/**
 * Before the loop has converged the image's surface may be far off, so the view makes room for at most this multiple of the depth map's
 * size.
 */
const MOST_ROOM = 1.8;
const NOWHERE = new Matrix4();

/** The matrix of P -> s R P + t. */
function matrixOf({ scale, rotation, translation }: Pose): Matrix4 {
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0] = rotation.map((value) => scale * value);
  const [x = 0, y = 0, z = 0] = translation;
  return new Matrix4().set(a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1);
}

export class Clouds {
  readonly #camera = new OrthographicCamera();
  readonly #controls: OrbitControls;
  readonly #renderer: Renderer;
  /** The size of the box, reported after a layout, because reading it earlier would force a second layout in each frame. */
  #size = { width: 0, height: 0 };
  readonly #resized = new ResizeObserver((entries) => {
    const { width, height } = entries.at(-1)?.contentRect ?? this.#size;
    this.#size = { width, height };
    this.#resize();
  });
  /** Changes since the present drawing began. */
  #next: Change | undefined;
  #drawing = false;
  #shown: Change["surfaces"];
  /** Bounding sphere of the surfaces. */
  #extent: Sphere | undefined;
  /** The pose under which the depth map's points are given, and the pose in which they are drawn. */
  #pose: Matrix4 | undefined;
  #standing = NOWHERE.clone();
  #swings = 0;
  #bounds = new Sphere(new Vector3(), 1);
  /** Bounding sphere of the pinned surfaces. */
  #pinned: Sphere | undefined;
  #marked: Record<Side, readonly number[] | null> = { image: null, depth: null };
  readonly #marks: Record<Side, HTMLElement>;

  /** Rejects where the browser has no WebGL. */
  static async open(canvas: HTMLCanvasElement, box: HTMLElement, hooks: CloudsHooks): Promise<Clouds> {
    return new Clouds(canvas, box, await rendererFor(canvas, hooks));
  }

  private constructor(canvas: HTMLCanvasElement, box: HTMLElement, renderer: Renderer) {
    this.#renderer = renderer;
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#marks = {
      image: make("span", { class: "dot image", hidden: true }),
      depth: make("span", { class: "dot depth", hidden: true }),
    };
    box.append(this.#marks.image, this.#marks.depth);
    // One finger scrolls the page vertically and rotates the clouds horizontally; two fingers rotate them in any direction.
    canvas.style.touchAction = "pan-y";
    this.#controls.touches.TWO = TOUCH.DOLLY_ROTATE;
    // The clouds rotate a little before the browser knows which gesture it is.
    canvas.addEventListener("pointerdown", ({ pointerType, isPrimary }) => {
      if (pointerType === "touch" && isPrimary) this.#controls.saveState();
    });
    canvas.addEventListener("pointercancel", ({ pointerType, isPrimary }) => {
      if (pointerType === "touch" && isPrimary) this.#controls.reset();
    });
    this.#controls.addEventListener("change", () => this.#look());
    this.#resized.observe(box);
    this.recolour();
  }

  /** Ends the drawing and frees the box. */
  end(): void {
    this.#swings++;
    this.#renderer.end();
    this.#resized.disconnect();
    this.#controls.dispose();
    for (const side of SIDES) this.#marks[side].remove();
  }

  /**
   * With `fresh` the new surfaces are seen from the front; otherwise the visitor's viewpoint stays. The depth map's points are given under
   * `pose`, and move to the pose under which they are `seen`.
   */
  show(surfaces: Record<Side, Surface>, pose: Pose, seen: Pose, fresh: boolean): void {
    this.#shown = surfaces;
    this.#extent = boundsOf(surfaces);
    if (fresh) this.home();
    else this.#follow();
    const before = this.#pose;
    this.#pose = matrixOf(pose);
    // The animation starts from the previous pose, expressed for the new points.
    const from =
      before && !fresh
        ? this.#standing.clone().multiply(before).multiply(this.#pose.clone().invert())
        : NOWHERE.clone();
    this.#makeRoom();
    this.#change({ surfaces: this.#shown });
    this.#placePinned();
    void this.#swing(from, this.#apart(seen));
  }

  /** Keeps surfaces as they are under a pose, to be shown left of the wipe. */
  pin(surfaces: Record<Side, Surface>, pose: Pose, seen: Pose): void {
    this.#pinned = boundsOf(surfaces);
    const pinned: PinnedSurfaces = { surfaces, swing: matrixOf(seen).multiply(matrixOf(pose).invert()).toArray() };
    this.#change({ pinned });
    this.#placePinned();
  }

  unpin(): void {
    this.#pinned = undefined;
    this.#change({ pinned: null });
  }

  /** Share of the width that shows the pinned run. */
  wipe(share: number): void {
    this.#change({ wipe: share });
  }

  /**
   * Moves the pinned run to the present run, if the image does not determine the distance or the pixels of the runs differ in size.
   */
  #placePinned(): void {
    const [then, now] = [this.#pinned, this.#extent];
    if (!then || !now) return;
    const growth = now.radius / then.radius;
    const size = Math.max(growth, 1 / growth) > OTHER_SIZE ? growth : 1;
    const isElsewhere = size !== 1 || now.center.distanceTo(then.center) > LEFT_THE_MIDDLE * now.radius;
    const place = isElsewhere
      ? new Matrix4().makeScale(size, size, size).setPosition(now.center.clone().addScaledVector(then.center, -size))
      : NOWHERE;
    this.#change({ pinnedPlace: place.toArray() });
  }

  /** The transformation from the pose under which the points are given to another pose. */
  #apart(pose: Pose): Matrix4 {
    return this.#pose ? matrixOf(pose).multiply(this.#pose.clone().invert()) : NOWHERE;
  }

  /** Shows the depth map in another pose, or again in its own. */
  pretend(pose: Pose | undefined): void {
    void this.#swing(this.#standing, pose ? this.#apart(pose) : NOWHERE);
  }

  /** Marks a point of each surface that has one. */
  mark(points: Record<Side, readonly number[] | null>): void {
    this.#marked = points;
    this.#placeMarks();
  }

  #placeMarks(): void {
    for (const side of SIDES) {
      const point = this.#marked[side];
      const mark = this.#marks[side];
      mark.hidden = !point;
      if (!point) continue;
      const { x, y } = new Vector3(...point).applyMatrix4(this.#toScreen(side));
      mark.style.left = `${50 * (1 + x)}%`;
      mark.style.top = `${50 * (1 - y)}%`;
    }
  }

  /** The matrix that projects a surface's points onto the screen, whose coordinates range from -1 to 1. */
  #toScreen(side: Side): Matrix4 {
    const camera = this.#camera.projectionMatrix.clone().multiply(this.#camera.matrixWorld.clone().invert());
    return side === "depth" ? camera.multiply(this.#standing) : camera;
  }

  /** The pixel whose point is drawn at a place of the box, CSS pixels. */
  pick(x: number, y: number): Asked | null {
    const { width, height } = this.#size;
    let found: Asked | null = null;
    let least = Infinity;
    for (const side of SIDES) {
      const surface = this.#shown?.[side];
      if (!surface || surface.width === 0) continue;
      const m = this.#toScreen(side).elements;
      const { points } = surface;
      for (let i = 0; 3 * i < points.length; i++) {
        const [a, b, c] = [points[3 * i] ?? NaN, points[3 * i + 1] ?? NaN, points[3 * i + 2] ?? NaN];
        const across = 0.5 * width * (1 + (m[0] ?? 0) * a + (m[4] ?? 0) * b + (m[8] ?? 0) * c + (m[12] ?? 0)) - x;
        const down = 0.5 * height * (1 - (m[1] ?? 0) * a - (m[5] ?? 0) * b - (m[9] ?? 0) * c - (m[13] ?? 0)) - y;
        const squared = (across * across + down * down) / REACH ** 2;
        if (!(squared < 1)) continue;
        const depth = (m[2] ?? 0) * a + (m[6] ?? 0) * b + (m[10] ?? 0) * c + (m[14] ?? 0);
        const cost = squared + IN_FRONT * depth;
        if (cost >= least) continue;
        least = cost;
        const { left, top, stride } = surface;
        found = {
          side,
          pixel: { column: left + stride * (i % surface.width), row: top + stride * Math.floor(i / surface.width) },
        };
      }
    }
    return found;
  }

  setStyle(style: "points" | "surfaces"): void {
    this.#change({ style });
  }

  async #swing(from: Matrix4, to: Matrix4): Promise<void> {
    const turn = ++this.#swings;
    const [start, end] = [from, to].map(partsOf);
    if (!start || !end) return;
    const far = [...from.elements].some((value, i) => Math.abs(value - (to.elements[i] ?? 0)) > 1e-4);
    const began = performance.now();
    let share = still.matches || !far ? 1 : 0;
    for (;;) {
      const eased = share * share * (3 - 2 * share);
      this.#standing = new Matrix4().compose(
        start.place.clone().lerp(end.place, eased),
        start.turn.clone().slerp(end.turn, eased),
        start.size.clone().lerp(end.size, eased),
      );
      this.#change({ swing: this.#standing.toArray() });
      this.#placeMarks();
      if (share >= 1) return;
      await new Promise(requestAnimationFrame);
      if (turn !== this.#swings) return;
      share = Math.min(1, (performance.now() - began) / SWING);
    }
  }

  /**
   * Looks from the colour camera, but a little from the side, so that depth can be seen. The depth map sets the size: it was measured,
   * whereas the image's surface can be anything before the loop has settled.
   */
  home(): void {
    if (!this.#extent) return;
    const bounds = (this.#bounds = this.#extent.clone());
    const { center, radius } = bounds;
    this.#camera.up.set(0, -1, 0);
    this.#camera.position.set(center.x + 1.2 * radius, center.y - 0.8 * radius, center.z - 2.5 * radius);
    this.#camera.near = 0.01 * radius;
    this.#camera.far = 10 * radius;
    this.#camera.zoom = 1;
    this.#controls.target.copy(center);
    this.#controls.update();
    this.#resize();
  }

  /** Follows surfaces that have left the centre, for example when the pose fixes their distance; the viewpoint stays. */
  #follow(): void {
    const center = this.#extent?.center;
    if (!center || center.distanceTo(this.#bounds.center) < LEFT_THE_MIDDLE * this.#bounds.radius) return;
    const moved = center.clone().sub(this.#bounds.center);
    this.#bounds.center.copy(center);
    this.#controls.target.add(moved);
    this.#camera.position.add(moved);
    this.#controls.update();
  }

  /**
   * Moves the viewpoint back if a surface is cut off, for example because a larger scale was found, unless the visitor has chosen the
   * distance.
   */
  #makeRoom(): void {
    const [shown, size] = [this.#shown, this.#extent?.radius];
    const isMoved =
      this.#camera.zoom !== 1 || this.#controls.target.distanceTo(this.#bounds.center) > 1e-6 * this.#bounds.radius;
    if (!shown || !size || isMoved || this.#size.width === 0) return;
    this.#camera.updateMatrixWorld();
    const camera = this.#toScreen("image");
    const reach = Math.max(...SIDES.map((side) => reachOf(shown[side].points, camera)));
    if (!(reach > EDGE)) return;
    this.#bounds.radius = Math.max(this.#bounds.radius, Math.min(ROOM * reach * this.#bounds.radius, MOST_ROOM * size));
    this.#resize();
  }

  /** Rotates the view by keyboard, degrees about the vertical and the horizontal axis. */
  turn(across: number, down: number): void {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const side = new Vector3().crossVectors(this.#camera.up, offset).normalize();
    offset.applyAxisAngle(this.#camera.up, (across * Math.PI) / 180).applyAxisAngle(side, (down * Math.PI) / 180);
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.#look();
  }

  recolour(): void {
    this.#change({ inks: { image: ink("cloud-image"), depth: ink("cloud-depth") } });
  }

  #resize(): void {
    const { width, height } = this.#size;
    if (width === 0 || height === 0) return;
    const reach = 0.95 * this.#bounds.radius;
    const [across, down] = width > height ? [(reach * width) / height, reach] : [reach, (reach * height) / width];
    Object.assign(this.#camera, { left: -across, right: across, top: down, bottom: -down });
    this.#camera.updateProjectionMatrix();
    this.#look();
  }

  #look(): void {
    const { width, height } = this.#size;
    if (width === 0 || height === 0) return;
    this.#camera.updateMatrixWorld();
    const [world, projection] = [this.#camera.matrixWorld.toArray(), this.#camera.projectionMatrix.toArray()];
    this.#change({ sight: { width, height, pixelRatio: Math.min(2, devicePixelRatio), world, projection } });
    this.#placeMarks();
  }

  /** Draws one state after the other; states that arrive faster than they can be drawn are skipped. */
  #change(change: Change): void {
    this.#next = { ...this.#next, ...change };
    if (!this.#drawing) void this.#drawAll();
  }

  async #drawAll(): Promise<void> {
    this.#drawing = true;
    // Transferring the surfaces is a separate task, because it takes as long as reading them.
    await nextTask();
    while (this.#next) {
      const next = this.#next;
      this.#next = undefined;
      await this.#renderer.draw(next);
    }
    this.#drawing = false;
  }
}

interface Parts {
  place: Vector3;
  turn: Quaternion;
  size: Vector3;
}

function partsOf(matrix: Matrix4): Parts {
  const parts = { place: new Vector3(), turn: new Quaternion(), size: new Vector3() };
  matrix.decompose(parts.place, parts.turn, parts.size);
  return parts;
}

/** The depth map was measured; the image's surface is used where it has no value. */
const boundsOf = ({ depth, image }: Record<Side, Surface>): Sphere | undefined =>
  extent(depth.points) ?? extent(image.points);

/** A sphere around most of the points, so that a few outliers do not shrink the rest to a dot. */
function extent(points: Float32Array): Sphere | undefined {
  const places: number[] = [];
  const every = Math.max(1, Math.floor(points.length / 3 / 2000));
  for (let i = 0; i + 2 < points.length; i += 3 * every) {
    if (Number.isFinite((points[i] ?? NaN) + (points[i + 1] ?? NaN) + (points[i + 2] ?? NaN))) places.push(i);
  }
  const spans = [0, 1, 2].map((axis) => {
    const sorted = Float32Array.from(places, (i) => points[i + axis] ?? NaN).sort();
    const low = sorted[Math.floor(0.01 * sorted.length)];
    const high = sorted[Math.ceil(0.99 * sorted.length) - 1];
    return low === undefined || high === undefined ? undefined : { middle: (low + high) / 2, half: (high - low) / 2 };
  });
  const [x, y, z] = spans;
  if (!x || !y || !z) return undefined;
  return new Sphere(new Vector3(x.middle, y.middle, z.middle), Math.hypot(x.half, y.half, z.half) || 1);
}

/** The reach of most of the points from the middle of the window, 1 at its edge. */
function reachOf(points: Float32Array, toScreen: Matrix4): number {
  const every = Math.max(1, Math.floor(points.length / 3 / 2000));
  const reaches: number[] = [];
  const point = new Vector3();
  for (let i = 0; i + 2 < points.length; i += 3 * every) {
    const { x, y } = point.fromArray(points, i).applyMatrix4(toScreen);
    if (Number.isFinite(x + y)) reaches.push(Math.max(Math.abs(x), Math.abs(y)));
  }
  return reaches.sort((a, b) => a - b)[Math.ceil(0.99 * reaches.length) - 1] ?? 0;
}
