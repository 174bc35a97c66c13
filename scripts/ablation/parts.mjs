// The parts of the method that can be switched off individually. Each lists the source lines that are replaced.
//
// A line must occur exactly once, so that a part that has moved fails with its name instead of measuring nothing. Parts that the options
// of the package can leave out are measured by `npm run tables -- --only ablation`.
import { Failure } from "../shell.mjs";

const CONTRAST = "src/pose/contrast";
const PAINTED = "src/estimator/finder/local_contrast.rs";

const objective = (from, to) => ({ file: `${CONTRAST}/objective.rs`, from, to });
const LIMBS = [
  objective("const LIMB_WEIGHT: f64 = 1.0;", "const LIMB_WEIGHT: f64 = 0.0;"),
  objective("const SETTLING_LIMB_WEIGHT: f64 = 0.1;", "const SETTLING_LIMB_WEIGHT: f64 = 0.0;"),
];

/** `what` completes the phrase "without ..". */
export const PARTS = [
  {
    name: "instruments",
    what: "the last rounds by the gradient of the predicted shading, where contrast decides",
    changes: [{ file: `${CONTRAST}/registration.rs`, from: "if effort.instrument_rounds > 0 {", to: "if false {" }],
  },
  {
    name: "paint",
    what: "paint taken out at edges before contrast is compared",
    changes: [
      {
        file: PAINTED,
        from: "let image = sharp.as_ref().unwrap_or(&pair.image).without_paint().map(Box::new);",
        to: "let image: Option<Box<ColourView>> = None;",
      },
    ],
  },
  {
    name: "following",
    what: "the pose of a painted object following the paint that is found under it",
    changes: [
      { file: "src/estimator/stages/contrasted.rs", from: "const ROUNDS: usize = 3;", to: "const ROUNDS: usize = 0;" },
    ],
  },
  {
    name: "contrast",
    what: "the whole way of painted objects: colours of one albedo decide",
    changes: [{ file: PAINTED, from: "pair.options.registration == Registration::Joint", to: "false" }],
  },
  {
    name: "outline",
    what: "limbs on the outline and points inside it",
    changes: [
      ...LIMBS,
      {
        file: "src/pose/silhouette.rs",
        from: "const OUTSIDE_WEIGHT: f64 = 3.0;",
        to: "const OUTSIDE_WEIGHT: f64 = 0.0;",
      },
    ],
  },
  { name: "limbs", what: "limbs on the outline", changes: LIMBS },
  {
    name: "size",
    what: "the prior on the apparent size, within a registration and among poses",
    changes: [
      objective("const SIZE_WEIGHT: f64 = 5.0;", "const SIZE_WEIGHT: f64 = 0.0;"),
      objective("const UNIT_WEIGHT: f64 = 1.0;", "const UNIT_WEIGHT: f64 = 0.0;"),
    ],
  },
  {
    name: "shares",
    what: "ranking poses by the share of contrast that is left, in place of its sum",
    changes: [objective("if all > 0.0 { value - left + left / all } else { f64::INFINITY }", "value")],
  },
  {
    name: "noise",
    what: "the noise of depth: told of the map, its smoothing, windows of normals chosen by it",
    changes: [
      { file: "src/view/cubic_normals.rs", from: "const NOISY: f32 = 0.06;", to: "const NOISY: f32 = f32::INFINITY;" },
      { file: "src/view/depth_noise.rs", from: "if first <= SURFACE_GROWTH * second {", to: "if true {" },
    ],
  },
  {
    name: "means",
    // A window of three quarters of an object leaves the mean over the whole object, which is the exposure.
    what: "local means: those over the whole object are taken off instead",
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
    what: "ranking contrast as softly as noisy depth tells it: on the sharp image instead",
    changes: [
      { file: "src/view/depth_noise.rs", from: "self.smoothing().sqrt().sqrt()", to: "0.0 * self.smoothing()" },
    ],
  },
  {
    name: "lift",
    what: "the tenth of the median that is added to intensities, so that shadows are no deep valleys of log S",
    changes: [{ file: `${CONTRAST}/registration.rs`, from: "const LIFT: f32 = 0.1;", to: "const LIFT: f32 = 0.0;" }],
  },
  {
    name: "blurred",
    what: "instrumental variables of the registration by colours: the sharp image's own gradient instead of the blurred one's",
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
    what: "normals of third order with their errors: central differences, all believed alike",
    changes: [{ file: "src/estimator/stages/colours.rs", from: "if !depth.normals_given {", to: "if false {" }],
  },
  {
    name: "confirmed",
    what: "the colours' word after contrast's: contrast's end is the end",
    changes: [{ file: PAINTED, from: "is_plain(pair, plain, &contrast)", to: "false" }],
  },
  {
    name: "sizes",
    what: "starts at three sizes: one, that of the units",
    changes: [
      { file: PAINTED, from: "const SIZES: [f64; 3] = [0.84, 1.0, 1.19];", to: "const SIZES: [f64; 1] = [1.0];" },
    ],
  },
  {
    name: "hues",
    what: "sharpening hues that JPEG has blurred",
    changes: [
      { file: PAINTED, from: "let sharp = pair.image.with_sharp_hues();", to: "let sharp: Option<ColourView> = None;" },
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
