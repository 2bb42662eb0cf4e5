/** The {@link Host} that a browser is, and a node that has websockets of its own. */

import type { Host, Socket, SocketEvents } from "./host.ts";

export const browserHost: Host = {
  open: openSocket,
  now: () => performance.now(),
  after(delayMs, callback) {
    const timer = setTimeout(callback, delayMs);
    return () => clearTimeout(timer);
  },
  random: Math.random,
};

function openSocket(url: string, subprotocol: string, events: SocketEvents): Socket {
  const socket = new WebSocket(url, subprotocol);
  socket.binaryType = "arraybuffer";
  socket.addEventListener("open", () => events.onOpen());
  socket.addEventListener("message", ({ data }: MessageEvent<string | ArrayBuffer>) =>
    events.onMessage(typeof data === "string" ? data : new Uint8Array(data)),
  );
  socket.addEventListener("close", ({ code, reason }) => events.onClose(code, reason));
  return {
    send(data) {
      if (socket.readyState === WebSocket.OPEN) socket.send(data);
    },
    get backlog() {
      return socket.bufferedAmount;
    },
    close: (code) => socket.close(code),
  };
}
