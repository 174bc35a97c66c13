export default { optimizeDeps: { exclude: ["bimodal-stereo"] } };
