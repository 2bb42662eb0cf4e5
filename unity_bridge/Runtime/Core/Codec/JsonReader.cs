using System.Globalization;
using System.Text;

namespace AgentServer
{
    /// <summary>Reads JSON as RFC 8259 has it, and nothing else.</summary>
    sealed class JsonReader : WireReader
    {
        readonly bool[] _isFirst = new bool[DepthLimit + 1];
        readonly StringBuilder _unescaped = new StringBuilder();
        string _text;
        int _at;

        /// <summary>Starts with a message.</summary>
        public void Load(string text)
        {
            _text = text;
            Restart();
        }

        public override void BeginMap()
        {
            Expect('{', "a map");
            Enter();
            _isFirst[Depth] = true;
        }

        public override string NextKey()
        {
            if (!NextOf('}')) return null;
            AtKey(null);
            string key = AnyStr();
            Expect(':', "a colon");
            return AtKey(key);
        }

        public override void BeginArray()
        {
            Expect('[', "an array");
            Enter();
            _isFirst[Depth] = true;
        }

        public override bool NextItem()
        {
            if (!NextOf(']')) return false;
            AtNextItem();
            return true;
        }

        public override bool Null()
        {
            if (Peek() != 'n') return false;
            Word("null");
            return true;
        }

        public override bool Bool()
        {
            char head = Peek();
            if (head == 't') return Word("true");
            if (head == 'f') return !Word("false");
            throw Unexpected("true or false");
        }

        public override void Skip()
        {
            switch (Peek())
            {
                case '{':
                    BeginMap();
                    while (NextKey() != null) Skip();
                    break;
                case '[':
                    BeginArray();
                    while (NextItem()) Skip();
                    break;
                case '"':
                    AnyStr();
                    break;
                case 'n':
                    Word("null");
                    break;
                case 't':
                case 'f':
                    Bool();
                    break;
                default:
                    bool isWhole;
                    NumberText("a value", out isWhole);
                    break;
            }
        }

        public override void End()
        {
            if (Peek() != '\0' || _at < _text.Length) throw Unexpected("the end of the message");
        }

        protected override void Rewind()
        {
            _at = 0;
        }

        protected override long AnyInt()
        {
            bool isWhole;
            string number = NumberText("an integer", out isWhole);
            if (!isWhole) throw Error("expected an integer, got a number with a point or an exponent");
            long value;
            if (!long.TryParse(number, NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture, out value))
                throw Error("the number is out of range");
            return value;
        }

        protected override double AnyFloat()
        {
            bool isWhole;
            string number = NumberText("a number", out isWhole);
            double value;
            if (!Decimals.TryRead(number, out value)) throw Error("the number is out of range");
            return value;
        }

        protected override byte[] AnyBytes()
        {
            throw Error("bytes are sent in MessagePack only");
        }

        protected override string AnyStr()
        {
            Expect('"', "a text");
            int start = _at;
            bool isPlain = true;
            _unescaped.Clear();
            while (true)
            {
                if (_at >= _text.Length) throw Error("the message is cut off");
                char unit = _text[_at++];
                if (unit == '"') break;
                if (unit < ' ') throw Error("a text has a control character that is not escaped");
                if (unit == '\\')
                {
                    if (isPlain) _unescaped.Append(_text, start, _at - 1 - start);
                    isPlain = false;
                    unit = Escaped();
                }
                if (char.IsLowSurrogate(unit)) throw Error("a text has half of a surrogate pair");
                if (!isPlain) _unescaped.Append(unit);
                if (char.IsHighSurrogate(unit)) SecondHalf(isPlain);
            }
            return isPlain ? _text.Substring(start, _at - 1 - start) : _unescaped.ToString();
        }

        /// <summary>Reads the low surrogate that must follow a high one.</summary>
        void SecondHalf(bool isPlain)
        {
            char unit = _at < _text.Length ? _text[_at] : '\0';
            bool isEscape = unit == '\\';
            if (isEscape || char.IsLowSurrogate(unit)) _at++;
            if (isEscape && !isPlain) unit = Escaped();
            if (!char.IsLowSurrogate(unit)) throw Error("a text has half of a surrogate pair");
            if (!isPlain) _unescaped.Append(unit);
        }

        char Escaped()
        {
            char unit = _at < _text.Length ? _text[_at++] : '\0';
            switch (unit)
            {
                case '"': case '\\': case '/': return unit;
                case 'b': return '\b';
                case 'f': return '\f';
                case 'n': return '\n';
                case 'r': return '\r';
                case 't': return '\t';
                case 'u': return Hexadecimal();
                default: throw Error("a text has an escape that JSON does not know");
            }
        }

        char Hexadecimal()
        {
            int value = 0;
            for (int digit = 0; digit < 4; digit++)
            {
                char unit = _at < _text.Length ? _text[_at++] : '\0';
                int nibble = "0123456789abcdef".IndexOf(char.ToLowerInvariant(unit));
                if (nibble < 0) throw Error("a text has an escape without four hexadecimal digits");
                value = value << 4 | nibble;
            }
            return (char)value;
        }

        /// <summary>Moves to the next member; false, and the level is left, at its end.</summary>
        bool NextOf(char end)
        {
            bool isFirst = _isFirst[Depth];
            _isFirst[Depth] = false;
            if (Peek() == end)
            {
                _at++;
                Leave();
                return false;
            }
            if (!isFirst) Expect(',', "a comma");
            return true;
        }

        string NumberText(string expected, out bool isWhole)
        {
            Peek();
            int start = _at;
            if (Here() == '-') _at++;
            int lead = _at;
            int digits = Digits();
            if (digits == 0) throw Unexpected(expected);
            if (digits > 1 && _text[lead] == '0') throw Error("a number begins with a zero too many");
            isWhole = true;
            if (Here() == '.')
            {
                isWhole = false;
                _at++;
                if (Digits() == 0) throw Unexpected("a digit");
            }
            if (Here() == 'e' || Here() == 'E')
            {
                isWhole = false;
                _at++;
                if (Here() == '+' || Here() == '-') _at++;
                if (Digits() == 0) throw Unexpected("a digit");
            }
            return _text.Substring(start, _at - start);
        }

        int Digits()
        {
            int start = _at;
            while (Here() >= '0' && Here() <= '9') _at++;
            return _at - start;
        }

        bool Word(string word)
        {
            if (string.CompareOrdinal(_text, _at, word, 0, word.Length) != 0) throw Unexpected(word);
            _at += word.Length;
            return true;
        }

        void Expect(char unit, string expected)
        {
            if (Peek() != unit || _at >= _text.Length) throw Unexpected(expected);
            _at++;
        }

        /// <summary>The next character that is no white space; 0 at the end.</summary>
        char Peek()
        {
            while (Here() == ' ' || Here() == '\t' || Here() == '\n' || Here() == '\r') _at++;
            return Here();
        }

        char Here() => _at < _text.Length ? _text[_at] : '\0';

        ProtocolException Unexpected(string expected)
        {
            if (_at >= _text.Length) return Error("the message is cut off");
            return Error("expected " + expected + " at character " + _at + ", got '" + _text[_at] + "'");
        }
    }
}
