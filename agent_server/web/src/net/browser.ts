/** The browser behind the connection's {@link Host}. */

import type { Host, Socket, SocketEvents } from "./connection.ts";

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
  socket.addEventListener("open", () => events.onOpen());
  socket.addEventListener("message", ({ data }) => {
    if (typeof data === "string") events.onText(data);
  });
  socket.addEventListener("close", ({ code, reason }) => events.onClose(code, reason));
  return {
    send(data) {
      if (socket.readyState === WebSocket.OPEN) socket.send(data);
    },
    get backlog() {
      return socket.bufferedAmount;
    },
    close: () => socket.close(),
  };
}
