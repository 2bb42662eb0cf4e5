using System;

namespace AgentServer
{
    /// <summary>How messages are written on the wire.</summary>
    public enum Coding
    {
        /// <summary>Text; images are binary.</summary>
        Json,

        /// <summary>Binary; joints and points are packed as float32.</summary>
        MessagePack,
    }

    /// <summary>What a websocket carries: a text or bytes.</summary>
    public readonly struct Frame
    {
        /// <summary>A text message.</summary>
        public Frame(string text)
        {
            Text = text;
            Data = null;
        }

        /// <summary>A binary message.</summary>
        public Frame(byte[] data)
        {
            Text = null;
            Data = data;
        }

        /// <summary>The text; null for a binary message.</summary>
        public string Text { get; }

        /// <summary>The bytes; null for a text message.</summary>
        public byte[] Data { get; }
    }

    /// <summary>
    /// Turns messages into frames and back. One codec is used by one thread at a time: it keeps its
    /// buffers. Everything that is wrong with a frame is a <see cref="ProtocolException"/>.
    /// </summary>
    public abstract class Codec
    {
        /// <summary>Makes the codec of a coding.</summary>
        public static Codec Of(Coding coding)
        {
            return coding == Coding.Json ? (Codec)new JsonCodec() : new MsgpackCodec();
        }

        /// <summary>Name of the websocket subprotocol.</summary>
        public abstract string Subprotocol { get; }

        /// <summary>Encodes a message.</summary>
        /// <exception cref="ProtocolException">If it has no form in this coding.</exception>
        public abstract Frame Encode(Message message);

        /// <summary>Decodes what a server sent.</summary>
        /// <exception cref="ProtocolException">With the path of the field and what was expected.</exception>
        public abstract Message DecodeServer(Frame frame);

        /// <summary>Decodes what a client sent.</summary>
        /// <exception cref="ProtocolException">With the path of the field and what was expected.</exception>
        public abstract Message DecodeClient(Frame frame);

        internal delegate Message Reading(string type, WireReader reader);

        internal static Message Decode(WireReader reader, Reading read)
        {
            string type = reader.MessageType();
            Message message = read(type, reader);
            if (message == null)
            {
                reader.Skip();
                message = new UnknownMessage(type);
            }
            reader.End();
            return message;
        }
    }

    sealed class JsonCodec : Codec
    {
        readonly JsonReader _reader = new JsonReader();
        readonly JsonWriter _writer = new JsonWriter();
        readonly Reading _client = Dispatch.ClientJson;
        readonly Reading _server = Dispatch.ServerJson;

        public override string Subprotocol => ProtocolVersion.JsonSubprotocol;

        public override Frame Encode(Message message)
        {
            if (message is Image image) return new Frame(ImageFrame.Write(image));
            _writer.Clear();
            message.Write(_writer);
            return new Frame(_writer.ToString());
        }

        public override Message DecodeServer(Frame frame)
        {
            if (frame.Text == null)
                throw new ProtocolException("", "this connection speaks JSON, whose messages are text");
            return Read(frame.Text, _server);
        }

        public override Message DecodeClient(Frame frame)
        {
            return frame.Text == null ? ImageFrame.Read(frame.Data) : Read(frame.Text, _client);
        }

        Message Read(string text, Reading read)
        {
            _reader.Load(text);
            return Decode(_reader, read);
        }
    }

    sealed class MsgpackCodec : Codec
    {
        readonly MsgpackReader _reader = new MsgpackReader();
        readonly MsgpackWriter _writer = new MsgpackWriter();
        readonly Reading _client = Dispatch.ClientMsgpack;
        readonly Reading _server = Dispatch.ServerMsgpack;

        public override string Subprotocol => ProtocolVersion.MsgpackSubprotocol;

        public override Frame Encode(Message message)
        {
            _writer.Clear();
            Packed.Of(message).Write(_writer);
            return new Frame(_writer.ToArray());
        }

        public override Message DecodeServer(Frame frame) => Read(frame, _server);

        public override Message DecodeClient(Frame frame) => Read(frame, _client);

        Message Read(Frame frame, Reading read)
        {
            if (frame.Data == null)
                throw new ProtocolException("", "this connection speaks MessagePack, whose messages are binary");
            _reader.Load(frame.Data);
            return Decode(_reader, read);
        }
    }
}
