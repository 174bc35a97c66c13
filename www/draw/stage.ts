/** Draws both surfaces, as points or shaded. It does not use the page, so that it can run in a separate thread. */

import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Camera,
  DirectionalLight,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  Scene,
  WebGLRenderer,
  type WebGLRendererParameters,
} from "three";
import type { Side, Surface } from "../engine/protocol";

/** Sizes of a point on the screen, in CSS pixels: large enough to close a surface, small enough to keep two surfaces visible. */
const SMALLEST = 1.5;
const LARGEST = 6;

/** Multiple of the median distance of neighbours beyond which they are separated by an edge. */
const LONGEST_STEP = 6;

/** The viewpoint for both surfaces and the size: CSS pixels, matrices in three.js's layout. */
export interface Sight {
  width: number;
  height: number;
  pixelRatio: number;
  world: number[];
  projection: number[];
}

/** A change of the scene: absent parts stay as they are. */
export interface Change {
  surfaces?: Record<Side, Surface>;
  sight?: Sight;
  inks?: { image: string; depth: string };
  style?: "points" | "surfaces";
  /** The transformation of the depth map's surface relative to its pose, column by column. */
  swing?: number[];
  /** The surfaces of the pinned run, shown left of the wipe. */
  pinned?: PinnedSurfaces | null;
  /** The transformation that moves them to the surfaces of the present run. */
  pinnedPlace?: number[];
  /** Share of the width that shows the pinned run. */
  wipe?: number;
}

export interface PinnedSurfaces {
  surfaces: Record<Side, Surface>;
  /** The transformation `swing` of the pinned run. */
  swing: number[];
}

/** Messages to a drawing thread: whether it can draw (in older Safaris it cannot), then the canvas, then changes. */
export type Asked = "can you draw?" | OffscreenCanvas | Change;

/** Its replies: whether it can draw, whether it has the canvas, whether a change is drawn, and whether WebGL was lost. */
export type Told = boolean | { lost: boolean };

export class CloudStage {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new Camera();
  readonly #lamp = new DirectionalLight(0xffffff, 2.4);
  readonly #image = new Sheet(1);
  readonly #depth = new Sheet(0.85);
  readonly #pinned = { image: new Sheet(1), depth: new Sheet(0.85), isShown: false };
  /** Both surfaces of each run. */
  readonly #runs = { now: new Group(), pinned: new Group() };
  #wipe = 0;
  #sight: Sight | undefined;

  /** Throws if the browser has no WebGL. A browser may suspend WebGL for a while; that is reported, and the scene is drawn again afterwards. */
  constructor(canvas: NonNullable<WebGLRendererParameters["canvas"]>, onLost: (lost: boolean) => void) {
    // Points are squares: smooth edges would take half of the time in a browser without a graphics card.
    this.#renderer = new WebGLRenderer({ canvas, alpha: true });
    // Runs after the renderer's listener, which requests the context again and rebuilds its state.
    canvas.addEventListener("webglcontextlost", () => onLost(true));
    canvas.addEventListener("webglcontextrestored", () => {
      this.show({});
      onLost(false);
    });
    this.#runs.now.add(this.#image.group, this.#depth.group);
    this.#runs.pinned.add(this.#pinned.image.group, this.#pinned.depth.group);
    this.#runs.pinned.matrixAutoUpdate = false;
    this.#scene.add(this.#runs.now, this.#runs.pinned, this.#lamp, this.#lamp.target, new AmbientLight(0xffffff, 0.9));
    this.#camera.matrixWorldAutoUpdate = false;
  }

  show({ surfaces, sight, inks, style, swing, pinned, pinnedPlace, wipe }: Change): void {
    const sheets = [this.#image, this.#depth, this.#pinned.image, this.#pinned.depth];
    if (inks) {
      for (const { image, depth } of [{ image: this.#image, depth: this.#depth }, this.#pinned]) {
        image.ink(inks.image);
        depth.ink(inks.depth);
      }
    }
    if (style) for (const sheet of sheets) sheet.setStyle(style);
    if (surfaces) {
      this.#image.fill(surfaces.image);
      this.#depth.fill(surfaces.depth);
    }
    if (swing) this.#depth.place(swing);
    if (pinned !== undefined) this.#pin(pinned);
    if (pinnedPlace) place(this.#runs.pinned, pinnedPlace);
    if (wipe !== undefined) this.#wipe = wipe;
    if (sight) this.#look(sight);
    if (!this.#sight) return;
    for (const sheet of sheets) sheet.resizePoints(this.#sight);
    this.#render(this.#sight);
  }

  #pin(pinned: PinnedSurfaces | null): void {
    this.#pinned.isShown = pinned !== null;
    if (!pinned) return;
    this.#pinned.image.fill(pinned.surfaces.image);
    this.#pinned.depth.fill(pinned.surfaces.depth);
    this.#pinned.depth.place(pinned.swing);
  }

  /** Draws each run on its side of the wipe, from the same viewpoint. */
  #render({ width, height }: Sight): void {
    const edge = this.#pinned.isShown ? Math.round(this.#wipe * width) : 0;
    this.#renderer.setScissorTest(edge > 0);
    for (const [isPinned, from, to] of [
      [true, 0, edge],
      [false, edge, width],
    ] as const) {
      if (from === to) continue;
      this.#runs.pinned.visible = isPinned;
      this.#runs.now.visible = !isPinned;
      this.#renderer.setScissor(from, 0, to - from, height);
      this.#renderer.render(this.#scene, this.#camera);
    }
  }

  #look(sight: Sight): void {
    const { width, height, pixelRatio, world, projection } = sight;
    const old = this.#sight;
    if (width !== old?.width || height !== old.height || pixelRatio !== old.pixelRatio) {
      this.#renderer.setPixelRatio(pixelRatio);
      this.#renderer.setSize(width, height, false);
    }
    this.#camera.matrixWorld.fromArray(world);
    this.#camera.matrixWorldInverse.copy(this.#camera.matrixWorld).invert();
    this.#camera.projectionMatrix.fromArray(projection);
    this.#camera.projectionMatrixInverse.copy(this.#camera.projectionMatrix).invert();
    // A lamp from the upper left, under which shape is perceived best.
    this.#lamp.position.set(-0.5, 0.7, 1).transformDirection(this.#camera.matrixWorld);
    this.#sight = sight;
  }
}

function place(group: Group, matrix: number[]): void {
  group.matrix.copy(new Matrix4().fromArray(matrix));
  group.matrixWorldNeedsUpdate = true;
}

/** One surface, drawn as points or as a mesh. */
class Sheet {
  readonly group = new Group();
  readonly #points: Points<BufferGeometry, PointsMaterial>;
  readonly #mesh: Mesh<BufferGeometry, MeshLambertMaterial>;
  #ink = "#888";
  #last: Surface | undefined;
  #style: "points" | "surfaces" = "surfaces";

  constructor(opacity: number) {
    this.#points = new Points(
      new BufferGeometry(),
      new PointsMaterial({ sizeAttenuation: false, transparent: true, opacity: 0.75 }),
    );
    this.#mesh = new Mesh(
      new BufferGeometry(),
      new MeshLambertMaterial({ side: DoubleSide, transparent: opacity < 1, opacity }),
    );
    this.group.matrixAutoUpdate = false;
    for (const each of [this.#points, this.#mesh]) {
      each.frustumCulled = false;
      this.group.add(each);
    }
  }

  ink(colour: string): void {
    this.#ink = colour;
    this.#tint();
  }

  setStyle(style: "points" | "surfaces"): void {
    this.#style = style;
    if (this.#last) this.fill(this.#last);
  }

  place(matrix: number[]): void {
    place(this.group, matrix);
  }

  fill(drawn: Surface): void {
    this.#last = drawn;
    const kept = finite(drawn);
    const isMesh = this.#style === "surfaces" && drawn.width > 1;
    this.#mesh.visible = isMesh;
    this.#points.visible = !isMesh;
    const geometry = (isMesh ? this.#mesh : this.#points).geometry;
    set(geometry, "position", kept.points);
    if (kept.colours) set(geometry, "color", Float32Array.from(kept.colours, linear));
    else geometry.deleteAttribute("color");
    if (isMesh) {
      const triangles = triangulate(drawn, kept.at);
      geometry.setIndex(new BufferAttribute(triangles, 1));
      geometry.computeVertexNormals();
    }
    this.#tint();
  }

  resizePoints({ width, height }: Sight): void {
    const apart =
      Math.min(width, height) / Math.sqrt(Math.max(1, this.#points.geometry.getAttribute("position")?.count ?? 1));
    this.#points.material.size = Math.max(SMALLEST, Math.min(LARGEST, 0.6 * apart));
  }

  #tint(): void {
    const coloured = this.#last?.colours != null;
    for (const { material } of [this.#points, this.#mesh]) {
      if (material.vertexColors !== coloured) {
        material.vertexColors = coloured;
        material.needsUpdate = true;
      }
      material.color.set(coloured ? "#fff" : this.#ink);
    }
  }
}

/** Converts a byte for the screen to linear light. */
const linear = (byte: number): number => (byte / 255) ** 2.2;

/** Sets an attribute in place if it has the same length. */
function set(geometry: BufferGeometry, name: string, values: Float32Array): void {
  const old = geometry.getAttribute(name);
  if (old instanceof BufferAttribute && old.array.length === values.length) {
    old.copyArray(values);
    old.needsUpdate = true;
    return;
  }
  // Attributes of other lengths belong to another geometry.
  if (name === "position") geometry.dispose();
  geometry.setAttribute(name, new BufferAttribute(values, 3));
}

/** The valid points with their colours, and the index of each pixel's point. */
function finite({ points, colours }: Surface): { points: Float32Array; colours: Uint8Array | null; at: Int32Array } {
  const count = points.length / 3;
  const at = new Int32Array(count).fill(-1);
  const kept = new Float32Array(points.length);
  const tints = colours && new Uint8Array(points.length);
  let to = 0;
  for (let i = 0; i < count; i++) {
    if (!Number.isFinite((points[3 * i] ?? NaN) + (points[3 * i + 1] ?? NaN) + (points[3 * i + 2] ?? NaN))) continue;
    kept.set(points.subarray(3 * i, 3 * i + 3), 3 * to);
    if (colours) tints?.set(colours.subarray(3 * i, 3 * i + 3), 3 * to);
    at[i] = to++;
  }
  return { points: kept.slice(0, 3 * to), colours: tints ? tints.slice(0, 3 * to) : null, at };
}

/** Two triangles for each four neighbours that no edge separates. */
function triangulate({ width, height, points }: Surface, at: Int32Array): Uint32Array {
  const squared = (a: number, b: number): number => {
    let sum = 0;
    for (let c = 0; c < 3; c++) sum += ((points[3 * a + c] ?? NaN) - (points[3 * b + c] ?? NaN)) ** 2;
    return sum;
  };
  const steps: number[] = [];
  for (let i = 0; i + 1 < at.length; i += 7)
    if ((i + 1) % width !== 0 && (at[i] ?? -1) >= 0 && (at[i + 1] ?? -1) >= 0) steps.push(squared(i, i + 1));
  const longest = LONGEST_STEP ** 2 * (steps.sort((a, b) => a - b)[Math.floor(steps.length / 2)] ?? 0);
  const found: number[] = [];
  const add = (a: number, b: number, c: number): void => {
    const corners = [at[a] ?? -1, at[b] ?? -1, at[c] ?? -1];
    if (
      corners.some((corner) => corner < 0) ||
      squared(a, b) > longest ||
      squared(b, c) > longest ||
      squared(c, a) > longest
    )
      return;
    found.push(...corners);
  };
  for (let row = 0; row + 1 < height; row++) {
    for (let column = 0; column + 1 < width; column++) {
      const i = row * width + column;
      add(i, i + width, i + 1);
      add(i + 1, i + width, i + width + 1);
    }
  }
  return Uint32Array.from(found);
}
