// Checks the calibration of a rig on a folder of frames with `npx bimodal-stereo check` from the build of this checkout.
//
// npm run build && node examples/check-folder.mjs --help
process.argv.splice(2, 0, "check");
await import("../pkg/cli.js");
