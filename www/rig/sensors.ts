/**
 * Published figures of common sensors, for rigs whose intrinsics are not known. Single devices differ from them by some percent, so they are
 * guesses, which cap the verdict. This table loads on demand.
 */

export interface Sensor {
  name: string;
  sides: readonly ("colour" | "depth")[];
  /** A picture size of the sensor; other sizes of the same shape are scaled. */
  width: number;
  height: number;
  /** Focal length at that size, px. */
  focal: number;
  /** The optical centre at that size, px, if it is not in the middle. */
  centre?: readonly [number, number];
}

const BOTH = ["colour", "depth"] as const;
const COLOUR = ["colour"] as const;
const DEPTH = ["depth"] as const;

/** The focal length, px, of a horizontal field of view in degrees. */
const ofView = (degrees: number, width: number): number => width / 2 / Math.tan((degrees * Math.PI) / 360);
/** Diagonal of the film frame to which equivalent focal lengths refer, mm. */
const FILM = Math.hypot(36, 24);
/** The focal length, px, of an equivalent focal length in mm. */
const ofFilm = (millimetres: number, width: number, height: number): number =>
  (millimetres / FILM) * Math.hypot(width, height);

export const SENSORS: readonly Sensor[] = [
  // The default of the ROS drivers for OpenNI, also named by the TUM RGB-D benchmark: f = 525, for colour and registered depth.
  { name: "Kinect for Xbox 360", sides: BOTH, width: 640, height: 480, focal: 525 },
  // The factory calibration that is published most often, 365.5, rounded.
  { name: "Kinect v2, depth", sides: DEPTH, width: 512, height: 424, focal: 365 },
  // The same for the colour camera: 1081.4, rounded.
  { name: "Kinect v2, colour", sides: COLOUR, width: 1920, height: 1080, focal: 1081 },
  // Factory calibrations: 0.492 of the sensor's 1024 px. The mode NFOV reads 640x576 px of it, from column 192 and row 180. The specified
  // field of view, 75 degrees, includes the distortion of the lens, and would give 417 px.
  { name: "Azure Kinect, NFOV depth", sides: DEPTH, width: 640, height: 576, focal: 504, centre: [319.5, 331.5] },
  // Factory calibration in pyk4a's issue 35: 0.479 of the width. The specified 90 degrees include the distortion as well.
  { name: "Azure Kinect, colour 16:9", sides: COLOUR, width: 1920, height: 1080, focal: 919 },
  // Intel's paper on tuning the D415 and the D435: about 645 and 940 px. The specified depth fields of view, 87 and 65 degrees, leave out
  // the edge that only one of the two cameras sees.
  { name: "RealSense D435, depth 16:9", sides: DEPTH, width: 1280, height: 720, focal: 645 },
  { name: "RealSense D415, depth 16:9", sides: DEPTH, width: 1280, height: 720, focal: 940 },
  // This mode reduces the sensor's 800 rows to 480.
  { name: "RealSense D435, depth 4:3", sides: DEPTH, width: 640, height: 480, focal: (645 * 480) / 800 },
  // Specifications of both: colour 69 degrees.
  { name: "RealSense D435, D415, colour 16:9", sides: COLOUR, width: 1920, height: 1080, focal: ofView(69, 1920) },
  // Specifications of the RealSense L515: depth 70 degrees, colour 70.
  { name: "RealSense L515, depth", sides: DEPTH, width: 1024, height: 768, focal: ofView(70, 1024) },
  { name: "RealSense L515, colour 16:9", sides: COLOUR, width: 1920, height: 1080, focal: ofView(70, 1920) },
  // Orbbec's specification of the Astra: 60 degrees.
  { name: "Orbbec Astra", sides: BOTH, width: 640, height: 480, focal: ofView(60, 640) },
  // ASUS's specification of the Xtion Pro Live: 58 degrees.
  { name: "Xtion Pro Live", sides: BOTH, width: 640, height: 480, focal: ofView(58, 640) },
  // Apple's specifications: 26 mm, equivalent to film by the diagonal. ARKit's depth map has the view of the colour picture.
  { name: "iPhone 12 Pro and 13 Pro, 4:3", sides: BOTH, width: 1920, height: 1440, focal: ofFilm(26, 1920, 1440) },
  // Apple's specifications: 24 mm equivalent.
  { name: "iPhone 14 Pro to 16 Pro, 4:3", sides: BOTH, width: 1920, height: 1440, focal: ofFilm(24, 1920, 1440) },
];
