/** A scout's thread in Node. */
import { parentPort } from "node:worker_threads";
import { serve } from "./scouting.js";

parentPort?.on("message", serve((answer) => parentPort?.postMessage(answer)));
