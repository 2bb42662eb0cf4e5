using System;
using System.Collections.Generic;
using System.IO;
using System.Text;

namespace AgentServer.Fixtures
{
    /// <summary>
    /// Reads `messages.json`, the messages that the codec of every language is tested with, decodes each
    /// entry and encodes it again in both codings. Prints a line of JSON for each. It is compiled
    /// together with the sources of Core, whose JSON reader it uses.
    /// </summary>
    static class Program
    {
        static readonly Codec Json = Codec.Of(Coding.Json);
        static readonly Codec Msgpack = Codec.Of(Coding.MessagePack);

        static int Main(string[] arguments)
        {
            if (arguments.Length != 1)
            {
                Console.Error.WriteLine("usage: Fixtures messages.json");
                return 2;
            }
            Console.OutputEncoding = new UTF8Encoding(false);
            foreach (IReadOnlyDictionary<string, string> entry in Entries(File.ReadAllText(arguments[0])))
                Console.WriteLine(Line(entry));
            return 0;
        }

        /// <summary>The array of flat maps of texts, or nulls, that the file is.</summary>
        static IReadOnlyList<IReadOnlyDictionary<string, string>> Entries(string text)
        {
            var reader = new JsonReader();
            reader.Load(text);
            return reader.List(
                int.MaxValue,
                item => item.Map(int.MaxValue, value => value.Null() ? null : value.Str(0, int.MaxValue)));
        }

        static string Line(IReadOnlyDictionary<string, string> entry)
        {
            bool isClient = entry["direction"] == "client";
            var line = new JsonWriter();
            line.BeginMap(0);
            Put(line, "name", entry["name"]);
            if (entry["json"] != null) Put(line, "json", Json, new Frame(entry["json"]), isClient);
            if (entry["json_binary_hex"] != null)
                Put(line, "json_binary_hex", Json, new Frame(Bytes(entry["json_binary_hex"])), isClient);
            if (entry["msgpack_hex"] != null)
                Put(line, "msgpack_hex", Msgpack, new Frame(Bytes(entry["msgpack_hex"])), isClient);
            line.EndMap();
            return line.ToString();
        }

        /// <summary>Adds what became of one form of an entry.</summary>
        static void Put(JsonWriter line, string form, Codec codec, Frame frame, bool isClient)
        {
            line.Key(form);
            line.BeginMap(0);
            try
            {
                Message message = isClient ? codec.DecodeClient(frame) : codec.DecodeServer(frame);
                bool isKnown = !(message is UnknownMessage);
                Put(line, "outcome", isKnown ? "ok" : "unknown");
                Put(line, "record", isKnown ? message.GetType().Name : null);
                if (isKnown) PutAgain(line, message);
            }
            catch (ProtocolException wrong)
            {
                Put(line, "outcome", "error");
                Put(line, "field", wrong.Field);
            }
            line.EndMap();
        }

        static void PutAgain(JsonWriter line, Message message)
        {
            bool isPacked = message is PackedSkeleton || message is PackedFacePoints || message is PackedPoseStreamMessage;
            Frame json = isPacked ? default(Frame) : Json.Encode(message);
            Put(line, "json", json.Text);
            Put(line, "json_binary_hex", json.Data == null ? null : Hexadecimal(json.Data));
            Put(line, "msgpack_hex", Hexadecimal(Msgpack.Encode(message).Data));
        }

        static void Put(JsonWriter line, string key, string value)
        {
            line.Key(key);
            if (value == null) line.Null();
            else line.Str(value);
        }

        static byte[] Bytes(string hexadecimal)
        {
            var bytes = new byte[hexadecimal.Length / 2];
            for (int index = 0; index < bytes.Length; index++)
                bytes[index] = Convert.ToByte(hexadecimal.Substring(2 * index, 2), 16);
            return bytes;
        }

        static string Hexadecimal(byte[] data) => BitConverter.ToString(data).Replace("-", "").ToLowerInvariant();
    }
}
