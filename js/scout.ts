/** A scout's thread in a browser: a module worker. */
import { serve, type Order } from "./scouting.js";

const handle = serve((answer) => self.postMessage(answer));
self.onmessage = (event: MessageEvent<Order>) => handle(event.data);
