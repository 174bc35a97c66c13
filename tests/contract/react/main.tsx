// The component of examples/react in strict mode, with counters of the estimators that it makes, runs to the end and frees.
import init, { Estimator, sample } from "bimodal-stereo";
import { StrictMode, useState } from "react";
import { createRoot } from "react-dom/client";
import { Pose } from "../../../examples/react/Pose";

const counts = { made: 0, freed: 0, ended: 0 };
Object.assign(window, { counts });
const { run, free } = Estimator.prototype;
Estimator.prototype.run = async function (options) {
  counts.made++;
  const report = await run.call(this, options);
  counts.ended++;
  return report;
};
Estimator.prototype.free = function () {
  counts.freed++;
  free.call(this);
};

await init();
/** The first pair takes far longer than a click; no pair is shown between the two. */
const pairs = [256, undefined, 64].map((size) => (size ? sample({ surface: "bust", light: "window", size }) : undefined));

function App() {
  const [turn, setTurn] = useState(0);
  const pair = pairs[turn];
  return (
    <>
      <button onClick={() => setTurn(turn + 1)}>next</button>
      {pair && <Pose image={pair.image} depth={pair.depth} />}
    </>
  );
}
createRoot(document.getElementById("app")!).render(<StrictMode><App /></StrictMode>);
