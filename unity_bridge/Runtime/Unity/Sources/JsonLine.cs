using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace AgentServer.Unity
{
    /// <summary>
    /// Reads one line of JSON into dictionaries, lists, texts, longs, doubles, bools and null. It is for
    /// recordings, whose lines are objects of any shape; messages have a codec of their own.
    /// </summary>
    sealed class JsonLine
    {
        const int DepthLimit = 64;

        readonly string _text;
        int _at;
        int _depth;

        JsonLine(string text)
        {
            _text = text;
        }

        /// <exception cref="FormatException">If the line is no JSON object.</exception>
        public static Dictionary<string, object> Object(string line)
        {
            var reader = new JsonLine(line);
            var value = reader.Value() as Dictionary<string, object>;
            if (value == null) throw new FormatException("expected an object in braces");
            if (reader.Peek() != '\0') throw reader.Wrong("the end of the line");
            return value;
        }

        object Value()
        {
            char first = Peek();
            if (first == '{') return Map();
            if (first == '[') return List();
            if (first == '"') return Text();
            if (first == 't') return Word("true", true);
            if (first == 'f') return Word("false", false);
            if (first == 'n') return Word("null", null);
            return Number();
        }

        Dictionary<string, object> Map()
        {
            var map = new Dictionary<string, object>();
            Enter('{');
            while (Peek() != '}')
            {
                if (map.Count > 0) Expect(',');
                Peek();
                string key = Text();
                Peek();
                Expect(':');
                map[key] = Value();
            }
            Leave();
            return map;
        }

        List<object> List()
        {
            var list = new List<object>();
            Enter('[');
            while (Peek() != ']')
            {
                if (list.Count > 0) Expect(',');
                list.Add(Value());
            }
            Leave();
            return list;
        }

        string Text()
        {
            Expect('"');
            var text = new StringBuilder();
            while (Here() != '"')
            {
                char unit = Here();
                if (unit < ' ') throw Wrong("the end of a text");
                _at++;
                text.Append(unit == '\\' ? Escaped() : unit);
            }
            _at++;
            return text.ToString();
        }

        char Escaped()
        {
            const string Escapes = "\"\\/bfnrt", Meanings = "\"\\/\b\f\n\r\t";
            char unit = Here();
            _at++;
            int known = Escapes.IndexOf(unit);
            if (known >= 0) return Meanings[known];
            ushort code;
            if (unit != 'u' || _at + 4 > _text.Length || !ushort.TryParse(
                    _text.Substring(_at, 4), NumberStyles.AllowHexSpecifier, CultureInfo.InvariantCulture, out code))
                throw Wrong("an escape");
            _at += 4;
            return (char)code;
        }

        object Number()
        {
            int start = _at;
            while ("+-.eE0123456789".IndexOf(Here()) >= 0) _at++;
            string text = _text.Substring(start, _at - start);
            // An identity may be larger than what a double holds exactly.
            long whole;
            if (long.TryParse(text, NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture, out whole)) return whole;
            double number;
            bool isOne = double.TryParse(
                text,
                NumberStyles.AllowLeadingSign | NumberStyles.AllowDecimalPoint | NumberStyles.AllowExponent,
                CultureInfo.InvariantCulture,
                out number);
            if (isOne && !double.IsInfinity(number)) return number;
            _at = start;
            throw Wrong("a value");
        }

        object Word(string word, object value)
        {
            if (string.CompareOrdinal(_text, _at, word, 0, word.Length) != 0) throw Wrong(word);
            _at += word.Length;
            return value;
        }

        void Enter(char bracket)
        {
            Expect(bracket);
            if (++_depth > DepthLimit) throw Wrong("fewer brackets within brackets");
        }

        void Leave()
        {
            _at++;
            _depth--;
        }

        void Expect(char unit)
        {
            if (Peek() != unit) throw Wrong("'" + unit + "'");
            _at++;
        }

        char Peek()
        {
            while (Here() == ' ' || Here() == '\t' || Here() == '\r' || Here() == '\n') _at++;
            return Here();
        }

        char Here() => _at < _text.Length ? _text[_at] : '\0';

        FormatException Wrong(string expected) =>
            new FormatException("expected " + expected + " at character " + (_at + 1));
    }
}
