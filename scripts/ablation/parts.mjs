// The parts of the method that can be switched off individually. Each lists the source lines that are replaced.
//
// A line must occur exactly once, so that a part that has moved fails with its name instead of measuring nothing. Parts that the options
// of the package can leave out are measured by `npm run tables -- --only ablation`.
import { Failure } from "../shell.mjs";

const CONTRAST = "src/pose/contrast";
const LOCAL_CONTRAST = "src/estimator/finder/local_contrast.rs";

const objective = (from, to) => ({ file: `${CONTRAST}/objective.rs`, from, to });
const CONTOURS = [
  objective("const CONTOUR_WEIGHT: f64 = 1.0;", "const CONTOUR_WEIGHT: f64 = 0.0;"),
  objective("const SETTLING_CONTOUR_WEIGHT: f64 = 0.1;", "const SETTLING_CONTOUR_WEIGHT: f64 = 0.0;"),
];

/** `what` completes the phrase "without ..". */
export const PARTS = [
  {
    name: "instruments",
    what: "the last rounds of local contrast, which use the gradient of the predicted shading",
    changes: [{ file: `${CONTRAST}/registration.rs`, from: "if effort.instrument_rounds > 0 {", to: "if false {" }],
  },
  {
    name: "albedo-steps",
    what: "the removal of albedo at edges before local contrast is compared",
    changes: [
      {
        file: LOCAL_CONTRAST,
        from: "let image = sharp.as_ref().unwrap_or(&pair.image).without_albedo_steps().map(Box::new);",
        to: "let image: Option<Box<ColourView>> = None;",
      },
    ],
  },
  {
    name: "following",
    what: "the rounds in which pose and albedo are improved in turn",
    changes: [
      { file: "src/estimator/contrasted.rs", from: "const ROUNDS: usize = 3;", to: "const ROUNDS: usize = 0;" },
    ],
  },
  {
    name: "gradients",
    what: "the registration in the gradient domain after local contrast",
    changes: [
      {
        file: "src/estimator/contrasted.rs",
        from: "gradients: gradients.map(Box::new)",
        to: "gradients: gradients.map(Box::new).filter(|_| false)",
      },
    ],
  },
  {
    name: "contrast",
    what: "registration by local contrast (photometric registration with a single albedo decides)",
    changes: [{ file: LOCAL_CONTRAST, from: "pair.options.registration == Registration::Joint", to: "false" }],
  },
  {
    name: "silhouette",
    what: "the terms that keep occluding contours on the silhouette and points inside it",
    changes: [
      ...CONTOURS,
      {
        file: "src/pose/silhouette.rs",
        from: "const OUTSIDE_WEIGHT: f64 = 3.0;",
        to: "const OUTSIDE_WEIGHT: f64 = 0.0;",
      },
    ],
  },
  { name: "contours", what: "the term that keeps occluding contours on the silhouette", changes: CONTOURS },
  {
    name: "size",
    what: "the prior on the apparent size, in a registration and in the ranking",
    changes: [
      objective("const SIZE_WEIGHT: f64 = 5.0;", "const SIZE_WEIGHT: f64 = 0.0;"),
      objective("const UNIT_WEIGHT: f64 = 1.0;", "const UNIT_WEIGHT: f64 = 0.0;"),
    ],
  },
  {
    name: "shares",
    what: "the ranking of poses by the share of contrast that is left (its sum ranks them)",
    changes: [objective("if all > 0.0 { value - left + left / all } else { f64::INFINITY }", "value")],
  },
  {
    name: "noise",
    what: "the noise of depth (its estimate, the smoothing, and the windows of normals that depend on it)",
    changes: [
      { file: "src/view/cubic_normals.rs", from: "const NOISY: f32 = 0.06;", to: "const NOISY: f32 = f32::INFINITY;" },
      { file: "src/view/depth_noise.rs", from: "if first <= SURFACE_GROWTH * second {", to: "if true {" },
    ],
  },
  {
    name: "means",
    // A window of three quarters of the object's size subtracts nearly the mean over the whole object, which only removes the exposure.
    what: "local means (the mean over the whole object is subtracted)",
    changes: [
      {
        file: `${CONTRAST}/registration.rs`,
        from: "const MEANS: [f64; LEVELS] = [3.0, 5.0];",
        to: "const MEANS: [f64; LEVELS] = [48.0, 48.0];",
      },
    ],
  },
  {
    name: "softness",
    what: "the blur that fits the image to noisy depth (poses are ranked on the sharp image)",
    changes: [
      { file: "src/view/depth_noise.rs", from: "self.smoothing().sqrt().sqrt()", to: "0.0 * self.smoothing()" },
    ],
  },
  {
    name: "lift",
    what: "the tenth of the median that is added to intensities, which limits the contrast of shadows",
    changes: [{ file: `${CONTRAST}/registration.rs`, from: "const LIFT: f32 = 0.1;", to: "const LIFT: f32 = 0.0;" }],
  },
  {
    name: "blurred",
    what: "the blurred image in photometric registration's instrumental variables (the sharp image gives the gradient)",
    changes: [
      {
        file: "src/pose/photometric/solver.rs",
        from: "pub(super) const INSTRUMENT_BLUR: f64 = 1.0;",
        to: "pub(super) const INSTRUMENT_BLUR: f64 = 0.0;",
      },
    ],
  },
  {
    name: "cubics",
    what: "normals of third order with their errors (central differences, all with equal weight)",
    changes: [{ file: "src/estimator/photometric.rs", from: "if !depth.normals_given {", to: "if false {" }],
  },
  {
    name: "confirmed",
    what: "photometric confirmation of the pose by local contrast",
    changes: [{ file: LOCAL_CONTRAST, from: "is_plain(pair, plain, &contrast)", to: "false" }],
  },
  {
    name: "sizes",
    what: "initial poses of three sizes (only the size that follows from the units)",
    changes: [
      {
        file: LOCAL_CONTRAST,
        from: "const SIZES: [f64; 3] = [0.84, 1.0, 1.19];",
        to: "const SIZES: [f64; 1] = [1.0];",
      },
    ],
  },
  {
    name: "chromaticity",
    what: "the sharpening of chromaticity that JPEG has blurred",
    changes: [
      {
        file: LOCAL_CONTRAST,
        from: "let sharp = pair.image.with_sharp_chromaticity();",
        to: "let sharp: Option<ColourView> = None;",
      },
    ],
  },
];

/** The method as it is. */
export const ALL = { name: "all", what: "nothing", changes: [] };

/** The contents of a source file without a part. */
export function without({ name, changes }, file, text) {
  return changes
    .filter((change) => change.file === file)
    .reduce((changed, { from, to }) => {
      const count = changed.split(from).length - 1;
      if (count === 1) return changed.replace(from, () => to);
      throw new Failure(`The part "${name}" cannot be switched off: ${file} has ${count} times, not once, "${from}".`);
    }, text);
}
