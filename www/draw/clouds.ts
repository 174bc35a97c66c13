/** Both surfaces in the colour view's frame, to be turned by hand. Loaded when first seen: three.js outweighs all the rest. */

import {
  BufferAttribute, BufferGeometry, Color, OrthographicCamera, Points, PointsMaterial, Scene, Sphere, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ink } from "../dom";

/** Sizes of a point on the screen, in CSS pixels: near enough to the next to make a surface, small enough to see two. */
const SMALLEST = 1.5;
const LARGEST = 6;

export class Clouds {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new OrthographicCamera();
  readonly #controls: OrbitControls;
  readonly #image: Points<BufferGeometry, PointsMaterial>;
  readonly #depth: Points<BufferGeometry, PointsMaterial>;
  readonly #box: HTMLElement;
  readonly #redraw: () => void;
  #bounds = new Sphere(new Vector3(), 1);

  /** Throws where the browser has no WebGL. `redraw` asks for a call of `draw` in the next frame. */
  constructor(canvas: HTMLCanvasElement, box: HTMLElement, redraw: () => void) {
    // Points are squares: smoothing their edges costs a browser without a graphics card half of its time.
    this.#renderer = new WebGLRenderer({ canvas, alpha: true });
    this.#box = box;
    this.#redraw = redraw;
    this.#image = cloud();
    this.#depth = cloud();
    this.#scene.add(this.#image, this.#depth);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.addEventListener("change", redraw);
    new ResizeObserver(() => this.#resize()).observe(box);
    this.recolour();
  }

  /** `fresh` looks at the new clouds from the front; otherwise the visitor's viewpoint stays. */
  show(image: Float32Array, depth: Float32Array, fresh: boolean): void {
    fill(this.#image, image);
    fill(this.#depth, depth);
    if (fresh) this.home();
    this.#redraw();
  }

  /**
   * From the colour camera, a little from the side so that depth can be seen. The depth map sets the size: it was
   * measured, whereas the image's surface can be anything before the loop has settled.
   */
  home(): void {
    const bounds = extent(this.#depth) ?? extent(this.#image);
    if (!bounds) return;
    this.#bounds = bounds;
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

  /** Turns the view by hand of the keyboard; degrees about the vertical and the horizontal axis. */
  turn(across: number, down: number): void {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const side = new Vector3().crossVectors(this.#camera.up, offset).normalize();
    offset.applyAxisAngle(this.#camera.up, (across * Math.PI) / 180).applyAxisAngle(side, (down * Math.PI) / 180);
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.#redraw();
  }

  recolour(): void {
    this.#image.material.color = new Color(ink("cloud-image"));
    this.#depth.material.color = new Color(ink("cloud-depth"));
    this.#redraw();
  }

  draw(): void {
    this.#renderer.render(this.#scene, this.#camera);
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#box;
    if (width === 0 || height === 0) return;
    this.#renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.#renderer.setSize(width, height, false);
    const reach = 1.05 * this.#bounds.radius;
    const [across, down] = width > height ? [(reach * width) / height, reach] : [reach, (reach * height) / width];
    Object.assign(this.#camera, { left: -across, right: across, top: down, bottom: -down });
    this.#camera.updateProjectionMatrix();
    for (const { geometry, material } of [this.#image, this.#depth]) {
      const apart = Math.min(width, height) / Math.sqrt(Math.max(1, geometry.getAttribute("position")?.count ?? 1));
      material.size = this.#renderer.getPixelRatio() * Math.max(SMALLEST, Math.min(LARGEST, 0.6 * apart));
    }
    this.#redraw();
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

/** A sphere about the bulk of the points: a few flying ones must not shrink the rest to a dot. */
function extent({ geometry }: Points<BufferGeometry, PointsMaterial>): Sphere | undefined {
  const axes: number[][] = [[], [], []];
  const array = geometry.getAttribute("position")?.array ?? [];
  const every = Math.max(1, Math.floor(array.length / 3 / 2000));
  for (let i = 0; i + 2 < array.length; i += 3 * every) {
    axes.forEach((axis, a) => axis.push(array[i + a] ?? 0));
  }
  const spans = axes.map((axis) => {
    axis.sort((a, b) => a - b);
    const low = axis[Math.floor(0.01 * axis.length)];
    const high = axis[Math.ceil(0.99 * axis.length) - 1];
    return low === undefined || high === undefined ? undefined : { middle: (low + high) / 2, half: (high - low) / 2 };
  });
  const [x, y, z] = spans;
  if (!x || !y || !z) return undefined;
  return new Sphere(new Vector3(x.middle, y.middle, z.middle), Math.hypot(x.half, y.half, z.half) || 1);
}
