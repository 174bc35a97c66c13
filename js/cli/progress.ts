/** A bar that moves on a terminal, and a line for each tenth elsewhere. */

const WIDTH = 24;

export interface Progress {
  show(share: number, message: string): void;
  end(): void;
}

export function progress(stream: NodeJS.WriteStream): Progress {
  let tenth = -1;
  return {
    show(share, message) {
      const bounded = Math.min(1, Math.max(0, share));
      const percent = `${Math.floor(100 * bounded)}`.padStart(3);
      if (stream.isTTY) {
        const full = Math.round(bounded * WIDTH);
        const room = Math.max(0, (stream.columns || 80) - WIDTH - 12);
        const bar = `${"#".repeat(full)}${"-".repeat(WIDTH - full)}`;
        stream.write(`\r[${bar}] ${percent} %  ${message.slice(0, room)}\x1b[K`);
      } else if (Math.floor(10 * bounded) > tenth) {
        tenth = Math.floor(10 * bounded);
        stream.write(`${percent} %  ${message}\n`);
      }
    },
    end: () => void (stream.isTTY && stream.write("\r\x1b[K")),
  };
}
