/** Lets events, timers and drawing run. It waits for a message, because timers wait 4 ms, or 1 s in hidden pages. */
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
