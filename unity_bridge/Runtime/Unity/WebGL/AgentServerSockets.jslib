// Websockets of the browser for WebGLTransport.cs, which asks for what happened once a frame. Nothing is
// called back into the program and nothing is allocated on its heap, so that no Emscripten version
// of Unity needs another way and no message leaves memory behind.

var AgentServerSockets = {
  $agentSockets: {
    OPEN: 1,
    TEXT: 2,
    BINARY: 3,
    CLOSE: 4,

    // A page that is hidden reads nothing. Beyond this many messages its socket is closed, and the
    // client connects anew when it is seen again.
    MOST: 512,
    TOO_SLOW: 4000,

    last: 0,
    byId: {},

    push: function (socket, kind, bytes, code) {
      if (kind !== agentSockets.CLOSE && socket.events.length >= agentSockets.MOST) {
        socket.events.length = 0;
        agentSockets.end(socket, agentSockets.TOO_SLOW, "too many messages waited to be read");
        socket.web.close(agentSockets.TOO_SLOW);
        return;
      }
      socket.events.push({ kind: kind, bytes: bytes, code: code });
    },

    // The last event of a socket, once.
    end: function (socket, code, reason) {
      if (socket.isOver) return;
      socket.isOver = true;
      agentSockets.push(socket, agentSockets.CLOSE, new TextEncoder().encode(reason), code);
    },

    front: function (id) {
      var socket = agentSockets.byId[id];
      return socket && socket.events.length > 0 ? socket.events[0] : null;
    },
  },

  // Opens a socket; its id, from 1.
  AgentServerOpen: function (url, subprotocol) {
    var id = ++agentSockets.last;
    var socket = { web: null, events: [], isOver: false };
    agentSockets.byId[id] = socket;
    try {
      socket.web = new WebSocket(UTF8ToString(url), UTF8ToString(subprotocol));
    } catch (error) {
      // The address cannot be read, or a page from https may not open ws.
      agentSockets.end(socket, 1006, String(error.message));
      return id;
    }
    socket.web.binaryType = "arraybuffer";
    socket.web.onopen = function () {
      if (!socket.isOver) agentSockets.push(socket, agentSockets.OPEN, null, 0);
    };
    socket.web.onmessage = function (event) {
      if (socket.isOver) return;
      var isText = typeof event.data === "string";
      agentSockets.push(
        socket,
        isText ? agentSockets.TEXT : agentSockets.BINARY,
        isText ? new TextEncoder().encode(event.data) : new Uint8Array(event.data),
        0
      );
    };
    socket.web.onclose = function (event) {
      agentSockets.end(socket, event.code, event.reason);
    };
    return id;
  },

  // What happened first and was not read yet: 0 nothing, 1 open, 2 text, 3 binary, 4 close.
  AgentServerNext: function (id) {
    var event = agentSockets.front(id);
    return event ? event.kind : 0;
  },

  // Length of its bytes: the message, or the reason of a close in UTF-8.
  AgentServerSize: function (id) {
    var event = agentSockets.front(id);
    return event && event.bytes ? event.bytes.length : 0;
  },

  // Close code of a close.
  AgentServerCode: function (id) {
    var event = agentSockets.front(id);
    return event ? event.code : 0;
  },

  // Copies the bytes to an array of that length, and forgets the event.
  AgentServerTake: function (id, buffer) {
    var event = agentSockets.front(id);
    if (!event) return;
    if (event.bytes) HEAPU8.set(event.bytes, buffer);
    agentSockets.byId[id].events.shift();
  },

  // Sends a message; bytes of a text are UTF-8.
  AgentServerSend: function (id, buffer, length, isText) {
    var socket = agentSockets.byId[id];
    if (!socket || socket.isOver || socket.web.readyState !== 1) return;
    var bytes = HEAPU8.slice(buffer, buffer + length);
    socket.web.send(isText ? new TextDecoder().decode(bytes) : bytes);
  },

  // Bytes that were sent and have not left yet.
  AgentServerWaiting: function (id) {
    var socket = agentSockets.byId[id];
    return socket && socket.web ? socket.web.bufferedAmount : 0;
  },

  // Closes a socket. A browser lets a page say 1000 and 3000 to 4999 only: 1001 is a goodbye too, and what
  // is none must not look like one.
  AgentServerClose: function (id, code, reason) {
    var socket = agentSockets.byId[id];
    if (!socket || socket.isOver) return;
    var isAllowed = code === 1000 || (code >= 3000 && code <= 4999);
    socket.web.close(isAllowed ? code : code === 1001 ? 1000 : 4000, UTF8ToString(reason));
  },

  // Forgets a socket that is over.
  AgentServerFree: function (id) {
    delete agentSockets.byId[id];
  },
};

autoAddDeps(AgentServerSockets, "$agentSockets");
mergeInto(LibraryManager.library, AgentServerSockets);
