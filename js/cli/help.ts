/** The manual of the commands. The text for `check` is the same, line by line, in the Rust and Python command lines. */

export const HELP = `Usage: bimodal-stereo COMMAND

Commands:
  check  checks the calibration between a colour camera and a depth camera over a folder of frames

  --help     prints this text; after a command, its manual
  --version  prints the version
`;

export const CHECK_HELP = `Usage: bimodal-stereo check FOLDER --calibration FILE [options]

Checks whether the extrinsics in FILE agree with the frames in FOLDER. FOLDER holds pairs of a colour image and a depth map, with
similar names or in the layout of TUM RGB-D or Redwood, and the cameras' intrinsics unless FILE holds them. FILE is a 4x4 matrix in
text, YAML or XML of OpenCV, Kalibr's camchain, a static transform of ROS, or JSON of Open3D or RealSense: P_colour = R P_depth + t.

  --calibration FILE  the extrinsics to check; give more to compare them
  --inverted          FILE maps colour to depth without saying so
  --cameras FILE      a file of intrinsics; may be repeated
  --unit METRES       metres per stored number of the depth maps; 0.001 for millimetres
  --frames N          largest number of pairs, spread over the folder; default 20
  --cues LIST         any of shading,edges,information,silhouette; default all
  --workers N         threads, 1 to 16; default 1
  --json OUT          writes the report as JSON; - is the standard output
  --report OUT.html   writes the report as a self-contained web page
  --help              prints this text
  --version           prints the version

Exit code: 0 consistent, 1 off, 2 undecided or consistent with a warning, 3 the input is bad or the check could not run, 130 interrupted.
`;
