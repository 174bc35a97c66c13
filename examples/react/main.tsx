import init, { sample } from "bimodal-stereo";
import { StrictMode, useMemo, useState } from "react";
import { createRoot } from "react-dom/client";
import { Pose } from "./Pose";

function App() {
  const [beta, setBeta] = useState(20);
  const [isShown, setShown] = useState(true);
  // Memoised, because a new pair object would restart the search.
  const { image, depth } = useMemo(() => sample({ surface: "bust", light: "window", angles: { beta } }), [beta]);
  return (
    <>
      <label>
        beta{" "}
        <input type="range" min={-60} max={60} value={beta} onChange={(event) => setBeta(event.target.valueAsNumber)} />{" "}
        {beta}
      </label>
      <button type="button" onClick={() => setShown(!isShown)}>
        {isShown ? "Stop" : "Start"}
      </button>
      {isShown && <Pose image={image} depth={depth} />}
    </>
  );
}

// `sample` needs the numerics.
await init();
createRoot(document.getElementById("app")!).render(
  <StrictMode>
    <App />
  </StrictMode>,
);
