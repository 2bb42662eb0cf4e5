using System;
using System.Text;

namespace AgentServer
{
    /// <summary>Reads MessagePack. Lengths are checked against what is there before anything is made.</summary>
    sealed class MsgpackReader : WireReader
    {
        static readonly UTF8Encoding Utf8 = new UTF8Encoding(false, true);

        readonly long[] _left = new long[DepthLimit + 1];
        byte[] _data;
        int _at;

        /// <summary>Starts with a message.</summary>
        public void Load(byte[] data)
        {
            _data = data;
            Restart();
        }

        public override void BeginMap()
        {
            byte head = Next();
            long count;
            if (head >= 0x80 && head <= 0x8f) count = head & 0x0f;
            else if (head == 0xde) count = Unsigned(2);
            else if (head == 0xdf) count = Unsigned(4);
            else throw Unexpected("a map", head);
            Begin(count, 2 * count);
        }

        public override string NextKey()
        {
            if (_left[Depth] == 0)
            {
                Leave();
                return null;
            }
            _left[Depth]--;
            AtKey(null);
            return AtKey(AnyStr());
        }

        public override void BeginArray()
        {
            byte head = Next();
            long count;
            if (head >= 0x90 && head <= 0x9f) count = head & 0x0f;
            else if (head == 0xdc) count = Unsigned(2);
            else if (head == 0xdd) count = Unsigned(4);
            else throw Unexpected("an array", head);
            Begin(count, count);
        }

        public override bool NextItem()
        {
            if (_left[Depth] == 0)
            {
                Leave();
                return false;
            }
            _left[Depth]--;
            AtNextItem();
            return true;
        }

        public override bool Null()
        {
            if (_at >= _data.Length || _data[_at] != 0xc0) return false;
            _at++;
            return true;
        }

        public override bool Bool()
        {
            byte head = Next();
            if (head == 0xc2) return false;
            if (head == 0xc3) return true;
            throw Unexpected("true or false", head);
        }

        public override void Skip()
        {
            byte head = Next();
            if (head <= 0x7f || head >= 0xe0) return;
            if (head <= 0x8f) SkipItems(2 * (head & 0x0f));
            else if (head <= 0x9f) SkipItems(head & 0x0f);
            else if (head <= 0xbf) Take(head & 0x1f);
            else SkipLong(head);
        }

        public override void End()
        {
            if (_at != _data.Length) throw Error((_data.Length - _at) + " bytes follow the message");
        }

        protected override void Rewind()
        {
            _at = 0;
        }

        protected override long AnyInt()
        {
            byte head = Next();
            if (IsInt(head)) return IntAfter(head);
            throw Unexpected("an integer", head);
        }

        protected override double AnyFloat()
        {
            byte head = Next();
            if (head == 0xcb) return BitConverter.Int64BitsToDouble((long)Unsigned64());
            if (head == 0xca) return Single(Unsigned(4));
            if (head == 0xcf) return Unsigned64();
            if (IsInt(head)) return IntAfter(head);
            throw Unexpected("a number", head);
        }

        protected override string AnyStr()
        {
            byte head = Next();
            long length;
            if (head >= 0xa0 && head <= 0xbf) length = head & 0x1f;
            else if (head == 0xd9) length = Unsigned(1);
            else if (head == 0xda) length = Unsigned(2);
            else if (head == 0xdb) length = Unsigned(4);
            else throw Unexpected("a text", head);
            int start = Take(length);
            try
            {
                return Utf8.GetString(_data, start, (int)length);
            }
            catch (DecoderFallbackException)
            {
                throw Error("is not valid UTF-8");
            }
        }

        protected override byte[] AnyBytes()
        {
            byte head = Next();
            long length;
            if (head == 0xc4) length = Unsigned(1);
            else if (head == 0xc5) length = Unsigned(2);
            else if (head == 0xc6) length = Unsigned(4);
            else throw Unexpected("bytes", head);
            int start = Take(length);
            var bytes = new byte[length];
            Buffer.BlockCopy(_data, start, bytes, 0, bytes.Length);
            return bytes;
        }

        static bool IsInt(byte head) => head <= 0x7f || head >= 0xe0 || head >= 0xcc && head <= 0xd3;

        long IntAfter(byte head)
        {
            switch (head)
            {
                case 0xcc: return Unsigned(1);
                case 0xcd: return Unsigned(2);
                case 0xce: return Unsigned(4);
                case 0xcf:
                    ulong value = Unsigned64();
                    if (value > long.MaxValue) throw Error("expected an integer below 2^63");
                    return (long)value;
                case 0xd0: return (sbyte)Unsigned(1);
                case 0xd1: return (short)Unsigned(2);
                case 0xd2: return (int)Unsigned(4);
                case 0xd3: return (long)Unsigned64();
                default: return (sbyte)head;
            }
        }

        void SkipLong(byte head)
        {
            switch (head)
            {
                case 0xc0: case 0xc2: case 0xc3: break;
                case 0xc4: case 0xd9: Take(Unsigned(1)); break;
                case 0xc5: case 0xda: Take(Unsigned(2)); break;
                case 0xc6: case 0xdb: Take(Unsigned(4)); break;
                case 0xc7: Take(Unsigned(1) + 1); break;
                case 0xc8: Take(Unsigned(2) + 1); break;
                case 0xc9: Take(Unsigned(4) + 1); break;
                case 0xcc: case 0xd0: Take(1); break;
                case 0xcd: case 0xd1: Take(2); break;
                case 0xca: case 0xce: case 0xd2: Take(4); break;
                case 0xcb: case 0xcf: case 0xd3: Take(8); break;
                case 0xd4: case 0xd5: case 0xd6: case 0xd7: case 0xd8: Take((1 << (head - 0xd4)) + 1); break;
                case 0xdc: SkipItems(Unsigned(2)); break;
                case 0xdd: SkipItems(Unsigned(4)); break;
                case 0xde: SkipItems(2 * Unsigned(2)); break;
                case 0xdf: SkipItems(2 * Unsigned(4)); break;
                default: throw Unexpected("a value", head);
            }
        }

        void SkipItems(long count)
        {
            Begin(count, count);
            for (long item = 0; item < count; item++) Skip();
            Leave();
        }

        /// <summary>Enters a map or an array that must have so many values, each of a byte at least.</summary>
        void Begin(long count, long values)
        {
            if (values > _data.Length - _at) throw Error("the message is cut off");
            Enter();
            _left[Depth] = count;
        }

        byte Next() => _data[Take(1)];

        /// <summary>Moves over so many bytes and says where they began.</summary>
        int Take(long count)
        {
            if (count > _data.Length - _at) throw Error("the message is cut off");
            int start = _at;
            _at += (int)count;
            return start;
        }

        long Unsigned(int bytes)
        {
            int start = Take(bytes);
            long value = 0;
            for (int index = 0; index < bytes; index++) value = value << 8 | _data[start + index];
            return value;
        }

        ulong Unsigned64() => (ulong)Unsigned(4) << 32 | (ulong)Unsigned(4);

        static float Single(long bits)
        {
            var bytes = BitConverter.GetBytes((uint)bits);
            return BitConverter.ToSingle(bytes, 0);
        }

        ProtocolException Unexpected(string expected, byte head) =>
            Error("expected " + expected + ", got a value that begins with 0x" + head.ToString("x2"));
    }
}
