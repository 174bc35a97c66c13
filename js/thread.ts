/** Another thread in a browser: a module worker. */
import { serve, type Order } from "./threads.js";

const handle = serve((answer, transfer) => self.postMessage(answer, { transfer }));
self.onmessage = (event: MessageEvent<Order>) => handle(event.data);
