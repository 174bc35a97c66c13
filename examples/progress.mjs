/** A progress bar on a terminal, and a line for each tenth elsewhere. */
export function progress(stream) {
  const width = 24;
  let tenth = -1;
  const show = (share, message) => {
    const bounded = Math.min(1, Math.max(0, share));
    const percent = `${Math.floor(100 * bounded)}`.padStart(3);
    if (stream.isTTY) {
      const full = Math.round(bounded * width);
      const room = Math.max(0, (stream.columns || 80) - width - 12);
      stream.write(`\r[${"#".repeat(full)}${"-".repeat(width - full)}] ${percent} %  ${message.slice(0, room)}\x1b[K`);
    } else if (Math.floor(10 * bounded) > tenth) {
      tenth = Math.floor(10 * bounded);
      stream.write(`${percent} %  ${message}\n`);
    }
  };
  return { show, end: () => void (stream.isTTY && stream.write("\r\x1b[K")) };
}
