using System;
using System.Text;

namespace AgentServer
{
    /// <summary>Writes MessagePack: the smallest head of every kind, floats as float64.</summary>
    sealed class MsgpackWriter : WireWriter
    {
        static readonly UTF8Encoding Utf8 = new UTF8Encoding(false, true);

        byte[] _data = new byte[1024];
        int _length;

        /// <summary>Forgets the message before.</summary>
        public void Clear()
        {
            _length = 0;
        }

        /// <summary>What was written, as an array of its own.</summary>
        public byte[] ToArray()
        {
            var data = new byte[_length];
            Buffer.BlockCopy(_data, 0, data, 0, _length);
            return data;
        }

        public override void BeginMap(int count, int most)
        {
            // The server's encoder chooses the head before it knows which fields it leaves out; bytes
            // that are the same in every language can be compared.
            if (most < 16) Head(0x80 | count);
            else if (most <= ushort.MaxValue) Head(0xde, count, 2);
            else Head(0xdf, count, 4);
        }

        public override void EndMap()
        {
        }

        public override void BeginArray(int count)
        {
            if (count < 16) Head(0x90 | count);
            else if (count <= ushort.MaxValue) Head(0xdc, count, 2);
            else Head(0xdd, count, 4);
        }

        public override void Item()
        {
        }

        public override void EndArray()
        {
        }

        public override void Null()
        {
            Head(0xc0);
        }

        public override void Bool(bool value)
        {
            Head(value ? 0xc3 : 0xc2);
        }

        public override void Int(long value)
        {
            if (value >= 0) Unsigned(value);
            else if (value >= -32) Head((byte)value);
            else if (value >= sbyte.MinValue) Head(0xd0, value, 1);
            else if (value >= short.MinValue) Head(0xd1, value, 2);
            else if (value >= int.MinValue) Head(0xd2, value, 4);
            else Head(0xd3, value, 8);
        }

        public override void Bytes(byte[] value)
        {
            if (value.Length <= byte.MaxValue) Head(0xc4, value.Length, 1);
            else if (value.Length <= ushort.MaxValue) Head(0xc5, value.Length, 2);
            else Head(0xc6, value.Length, 4);
            Reserve(value.Length);
            Buffer.BlockCopy(value, 0, _data, _length, value.Length);
            _length += value.Length;
        }

        protected override void FiniteFloat(double value)
        {
            Head(0xcb, BitConverter.DoubleToInt64Bits(value), 8);
        }

        protected override void AnyKey(string key)
        {
            AnyStr(key);
        }

        protected override void AnyStr(string value)
        {
            int length;
            try
            {
                length = Utf8.GetByteCount(value);
            }
            catch (EncoderFallbackException)
            {
                throw new ProtocolException(Field, "has half of a surrogate pair and cannot be sent");
            }
            if (length < 32) Head(0xa0 | length);
            else if (length <= byte.MaxValue) Head(0xd9, length, 1);
            else if (length <= ushort.MaxValue) Head(0xda, length, 2);
            else Head(0xdb, length, 4);
            Reserve(length);
            _length += Utf8.GetBytes(value, 0, value.Length, _data, _length);
        }

        void Unsigned(long value)
        {
            if (value < 0x80) Head((int)value);
            else if (value <= byte.MaxValue) Head(0xcc, value, 1);
            else if (value <= ushort.MaxValue) Head(0xcd, value, 2);
            else if (value <= uint.MaxValue) Head(0xce, value, 4);
            else Head(0xcf, value, 8);
        }

        void Head(int head)
        {
            Reserve(1);
            _data[_length++] = (byte)head;
        }

        void Head(int head, long value, int bytes)
        {
            Reserve(1 + bytes);
            _data[_length++] = (byte)head;
            for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
                _data[_length++] = (byte)(value >> shift);
        }

        void Reserve(int count)
        {
            if (_length + count <= _data.Length) return;
            Array.Resize(ref _data, Math.Max(2 * _data.Length, _length + count));
        }
    }
}
