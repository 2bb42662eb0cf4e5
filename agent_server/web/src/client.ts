/**
 * The client by itself, for pages and programs of one's own: built as `client.js`, which needs no
 * other file. docs/page.md says how to use it.
 */

export { browserHost } from "./net/browser.ts";
export { ClockEstimate } from "./net/clock.ts";
export {
  Connection,
  type Client,
  type ConnectionOptions,
  type Listener,
} from "./net/connection.ts";
export { socketUrl } from "./net/address.ts";
export type { Host, Socket, SocketEvents } from "./net/host.ts";
export { CommandLedger, type CancelReason, type Heard, type Reported } from "./net/ledger.ts";
export {
  RendererClient,
  type Objects,
  type RendererEvents,
  type RendererOptions,
} from "./net/renderer.ts";
export type { Fault, Phase, Status } from "./net/status.ts";
export { ProtocolError } from "./protocol/check.ts";
export { jsonCodec, type Codec, type Incoming, type Outgoing, type Wire } from "./protocol/codec.ts";
export * from "./protocol/codes.ts";
export type * from "./protocol/messages.ts";
export { msgpackCodec } from "./protocol/msgpack.ts";
