/** Lets events, timers and drawing happen. A message instead of a timer: timers wait 4 ms, hidden pages 1 s. */
export function breathe(): Promise<void> {
  return new Promise((resume) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      // An open port would keep Node from ending.
      port1.close();
      resume();
    };
    port2.postMessage(null);
  });
}
