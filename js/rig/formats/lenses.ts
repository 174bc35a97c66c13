/**
 * Lens models by the names that programs use: one table with all spellings. For a name that is not in it there is no default: the camera is
 * refused, or a warning names it (cameras.ts).
 */

/** `realsense` has librealsense's variants of Brown's model, `other` the known models that are not supported. */
type Family = "brown" | "fisheye" | "realsense" | "other";

/** Patterns of whole names, in lower-case letters and digits only. */
const BROWN = [
  "|none|no|null|undistorted|rectified|pinhole|simplepinhole|perspective|rectilinear|linear|standard",
  "plumbbob|radtan\\d*|radialtangential\\d*|radial|simpleradial|brown|brownconrady\\d*|opencv\\d*|fullopencv",
  "rational|rationalpolynomial|thinprism|tilted|tiltedrational|polynomialk6|distortedpinhole",
  "pinhole(?:none|brown|brownconrady|radtan\\d*|radialtangential|opencv|plumbbob)",
];
const FISHEYE = [
  "(?:pinhole|opencv)?(?:fisheye4?|fisheyeopencv|equi|equid4?|equidistant4?|equidistantdistortedpinhole|kb[48]?|kannalabrandt[48]?)",
];
/**
 * For both of these models librealsense projects as with Brown's model, except for products of terms. Its older versions used the inverse
 * direction for the second model.
 */
const REALSENSE = ["modifiedbrownconrady|inversebrownconrady"];
/** Models that are not supported, with their descriptions. */
const OTHERS: [pattern: string, meaning: string][] = [
  ["ds(?:none)?|doublesphere(?:none)?|xialpha", "double sphere"],
  ["eucm(?:none)?|(?:extended|enhanced)unified|pinholeeucm|alphabeta", "extended unified"],
  ["ucm|unified|catadioptric|cata", "unified"],
  ["omni(?:none|radtan)?|omnidir|omnidirectional|distortedomni|mei|xi|mirrorparameters", "omnidirectional"],
  ["(?:pinhole)?fov|fieldofview|atan|fovpinhole", "field of view"],
  ["f?theta|fthetacamera|fthetawindshield", "F-theta"],
  ["scaramuzza|ocam|ocamcalib|polynomialomni", "Scaramuzza's polynomial"],
  ["fisheyeradtanthinprism|fisheye62\\d?", "Aria's Fisheye624: make linear pictures with projectaria_tools"],
  ["thinprismfisheye|radtanthinprismfisheye|(?:simple)?radialfisheye|kb\\d+|kannalabrandt\\d+", "another fisheye"],
  ["division|simpledivision", "division"],
  ["equirectangular|spherical|panorama|panoramic|erp|latlong|cubemap", "a panorama"],
  [
    "orthophoto|stereographic|equisolid|equisolidangle|orthographic|splinedstereographic.*|cylindrical",
    "another projection",
  ],
  ["cahvore?|(?:non)?centralgeneric|generic|triangular", "another projection"],
];
const FAMILIES: [Family, string[]][] = [
  ["brown", BROWN],
  ["fisheye", FISHEYE],
  ["realsense", REALSENSE],
  ["other", OTHERS.map(([pattern]) => pattern)],
];
const TABLE = FAMILIES.map(([family, patterns]) => [family, new RegExp(`^(?:${patterns.join("|")})$`)] as const);

/** Additions in names of classes and enumerations: "distortion.brown_conrady", "LENSMODEL_OPENCV5", "EquidistantCamera". */
const BEFORE =
  /^(?:rs2?distortion|distortion|lensmodel|cameramodel|projectionmodel|cameratype|projection|lens|model|type)/;
const BEHIND = /(?:projection|camera|geometry|distortion|model|lens|type)$/;
const LONGEST = 80;

/** A lens by its name. */
export interface LensName {
  /** Undefined where the table does not have the name. */
  family: Family | undefined;
  /** A description of an unsupported model. */
  meaning?: string;
}

/** The model of a name in any spelling. */
export function lensNamed(written: string): LensName {
  let name = written
    .slice(0, LONGEST)
    .toLowerCase()
    .replace(/[^a-z0-9]/g, "");
  for (let step = 0; step < 4; step++) {
    const family = TABLE.find(([, is]) => is.test(name))?.[0];
    if (family === "other") return { family, ...meaningOf(name) };
    if (family !== undefined) return { family };
    const bare = name.replace(BEFORE, "").replace(BEHIND, "");
    if (bare === name || bare === "") break;
    name = bare;
  }
  return { family: undefined };
}

function meaningOf(name: string): { meaning?: string } {
  const meaning = OTHERS.find(([pattern]) => new RegExp(`^(?:${pattern})$`).test(name))?.[1];
  return meaning === undefined ? {} : { meaning };
}
