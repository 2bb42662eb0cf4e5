using System.Globalization;
using System.Text;

namespace AgentServer
{
    /// <summary>Writes compact JSON; numbers read back as the same.</summary>
    sealed class JsonWriter : WireWriter
    {
        readonly StringBuilder _text = new StringBuilder(1024);
        bool _isFirst = true;

        /// <summary>Forgets the message before.</summary>
        public void Clear()
        {
            _text.Clear();
            _isFirst = true;
        }

        /// <summary>What was written.</summary>
        public override string ToString() => _text.ToString();

        public override void BeginMap(int count, int most)
        {
            Open('{');
        }

        public override void EndMap()
        {
            Shut('}');
        }

        public override void BeginArray(int count)
        {
            Open('[');
        }

        public override void Item()
        {
            if (!_isFirst) _text.Append(',');
            _isFirst = false;
        }

        public override void EndArray()
        {
            Shut(']');
        }

        public override void Null()
        {
            _text.Append("null");
        }

        public override void Bool(bool value)
        {
            _text.Append(value ? "true" : "false");
        }

        public override void Int(long value)
        {
            _text.Append(value.ToString(CultureInfo.InvariantCulture));
        }

        public override void Bytes(byte[] value)
        {
            throw new ProtocolException(Field, "has bytes, which are sent in MessagePack only");
        }

        protected override void FiniteFloat(double value)
        {
            _text.Append(Number(value));
        }

        protected override void AnyKey(string key)
        {
            Item();
            AnyStr(key);
            _text.Append(':');
        }

        protected override void AnyStr(string value)
        {
            _text.Append('"');
            for (int at = 0; at < value.Length; at++)
            {
                char unit = value[at];
                if (char.IsSurrogate(unit))
                {
                    if (!char.IsSurrogatePair(value, at))
                        throw new ProtocolException(Field, "has half of a surrogate pair and cannot be sent");
                    _text.Append(unit).Append(value[++at]);
                }
                else if (unit == '"' || unit == '\\') _text.Append('\\').Append(unit);
                else if (unit < ' ') _text.Append("\\u").Append(((int)unit).ToString("x4"));
                else _text.Append(unit);
            }
            _text.Append('"');
        }

        static string Number(double value)
        {
            string text = Decimals.Write(value);
            bool isWhole = text.IndexOf('.') < 0 && text.IndexOf('E') < 0;
            return isWhole ? text + ".0" : text;
        }

        void Open(char bracket)
        {
            _text.Append(bracket);
            _isFirst = true;
        }

        void Shut(char bracket)
        {
            _text.Append(bracket);
            _isFirst = false;
        }
    }
}
