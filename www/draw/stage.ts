/** Draws both clouds. It needs no page, so that a thread of its own can do it. */

import { BufferAttribute, BufferGeometry, Camera, Points, PointsMaterial, Scene, WebGLRenderer, type WebGLRendererParameters } from "three";

/** Sizes of a point on the screen, in CSS pixels: near enough to the next to make a surface, small enough to see two. */
const SMALLEST = 1.5;
const LARGEST = 6;

/** From where both are seen, and how large: CSS pixels, matrices as three.js has them. */
export interface Sight {
  width: number;
  height: number;
  pixelRatio: number;
  world: number[];
  projection: number[];
}

/** What is drawn anew; the rest stays as it was. */
export interface Change {
  /** xyz interleaved, NaN where there is none. */
  clouds?: { image: Float32Array; depth: Float32Array };
  sight?: Sight;
  inks?: { image: string; depth: string };
}

export class CloudStage {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new Camera();
  readonly #image = cloud();
  readonly #depth = cloud();
  #sight: Sight | undefined;

  /** Throws where the browser has no WebGL. */
  constructor(canvas: NonNullable<WebGLRendererParameters["canvas"]>) {
    // Points are squares: smoothing their edges costs a browser without a graphics card half of its time.
    this.#renderer = new WebGLRenderer({ canvas, alpha: true });
    this.#scene.add(this.#image, this.#depth);
    this.#camera.matrixWorldAutoUpdate = false;
  }

  show({ clouds, sight, inks }: Change): void {
    if (inks) {
      this.#image.material.color.set(inks.image);
      this.#depth.material.color.set(inks.depth);
    }
    if (clouds) {
      fill(this.#image, clouds.image);
      fill(this.#depth, clouds.depth);
    }
    if (sight) this.#look(sight);
    if (!this.#sight) return;
    this.#resizePoints(this.#sight);
    this.#renderer.render(this.#scene, this.#camera);
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
    this.#sight = sight;
  }

  #resizePoints({ width, height }: Sight): void {
    for (const { geometry, material } of [this.#image, this.#depth]) {
      const apart = Math.min(width, height) / Math.sqrt(Math.max(1, geometry.getAttribute("position")?.count ?? 1));
      material.size = Math.max(SMALLEST, Math.min(LARGEST, 0.6 * apart));
    }
  }
}

function cloud(): Points<BufferGeometry, PointsMaterial> {
  const material = new PointsMaterial({ sizeAttenuation: false, transparent: true, opacity: 0.75 });
  const points = new Points(new BufferGeometry(), material);
  points.frustumCulled = false;
  return points;
}

function fill({ geometry }: Points<BufferGeometry, PointsMaterial>, positions: Float32Array): void {
  const finite = positions.every((value) => !Number.isNaN(value)) ? positions : withoutHoles(positions);
  const old = geometry.getAttribute("position");
  if (old instanceof BufferAttribute && old.array.length === finite.length) {
    old.copyArray(finite);
    old.needsUpdate = true;
  } else {
    geometry.dispose();
    geometry.setAttribute("position", new BufferAttribute(finite, 3));
  }
}

function withoutHoles(positions: Float32Array): Float32Array {
  const kept: number[] = [];
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const point = positions.subarray(i, i + 3);
    if (point.every(Number.isFinite)) kept.push(...point);
  }
  return new Float32Array(kept);
}
