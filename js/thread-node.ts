/** Another thread in Node. */
import { parentPort } from "node:worker_threads";
import { serve } from "./threads.js";

parentPort?.on("message", serve((answer, transfer) => parentPort?.postMessage(answer, transfer)));
