using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;
using System.Text.RegularExpressions;

namespace AgentServer
{
    /// <summary>
    /// Reads a message value by value, whatever its coding, and knows the path of the value that it
    /// stands at. Everything that does not fit is a <see cref="ProtocolException"/>.
    /// </summary>
    abstract class WireReader
    {
        /// <summary>Maps and arrays may not be nested deeper.</summary>
        public const int DepthLimit = 64;

        readonly string[] _keys = new string[DepthLimit + 1];
        readonly int[] _items = new int[DepthLimit + 1];
        int _tuple;

        /// <summary>How many maps and arrays are open.</summary>
        protected int Depth { get; private set; }

        public abstract void BeginMap();

        /// <summary>The next key; null, and the map is left, after the last one.</summary>
        public abstract string NextKey();

        public abstract void BeginArray();

        /// <summary>Whether another item follows; if none does, the array is left.</summary>
        public abstract bool NextItem();

        /// <summary>Whether the value is null; if so it is read.</summary>
        public abstract bool Null();

        public abstract bool Bool();

        /// <summary>Passes over a value of any kind.</summary>
        public abstract void Skip();

        protected abstract long AnyInt();

        protected abstract double AnyFloat();

        protected abstract string AnyStr();

        protected abstract byte[] AnyBytes();

        /// <summary>Goes back to the start of the message.</summary>
        protected abstract void Rewind();

        /// <summary>Throws unless the message is over.</summary>
        public abstract void End();

        /// <summary>The message's `type`; the reader stands at the start again.</summary>
        public string MessageType()
        {
            string key;
            BeginMap();
            while ((key = NextKey()) != null)
            {
                if (key != "type")
                {
                    Skip();
                    continue;
                }
                string type = AnyStr();
                Restart();
                return type;
            }
            throw new ProtocolException("type", "is missing");
        }

        public long Int(long least, long most)
        {
            long value = AnyInt();
            if (value < least || value > most)
                throw Error("expected an integer from " + Text(least) + " to " + Text(most) + ", got " + Text(value));
            return value;
        }

        public double Float() => Float(double.MinValue, double.MaxValue);

        public double Float(double least, double most)
        {
            double value = AnyFloat();
            if (double.IsNaN(value) || double.IsInfinity(value)) throw Error("expected a finite number");
            if (value < least || value > most)
                throw Error("expected a number from " + Text(least) + " to " + Text(most) + ", got " + Text(value));
            return value;
        }

        public double FloatAbove(double least, double most)
        {
            double value = Float(least, most);
            if (value == least) throw Error("expected a number above " + Text(least));
            return value;
        }

        /// <summary>A text; lengths are in code points.</summary>
        public string Str(int shortest, int longest)
        {
            string value = AnyStr();
            if (value.Length > longest || value.Length < shortest)
            {
                int length = CodePoints(value);
                if (length > longest || length < shortest)
                    throw Error(
                        "expected a text of " + Text(shortest) + " to " + Text(longest) + " characters, got " + Text(length));
            }
            return value;
        }

        public string Pattern(string pattern)
        {
            string value = AnyStr();
            if (!Regex.IsMatch(value, pattern, RegexOptions.CultureInvariant))
                throw Error("expected a text that matches " + pattern + ", got " + Quoted(value));
            return value;
        }

        /// <summary>Index of a text among those that may stand here.</summary>
        public int Choice(string[] texts)
        {
            string value = AnyStr();
            int index = Array.IndexOf(texts, value);
            if (index < 0) throw Error("expected one of " + string.Join(", ", texts) + "; got " + Quoted(value));
            return index;
        }

        public byte[] Bytes(int longest)
        {
            byte[] value = AnyBytes();
            if (value.Length > longest)
                throw Error("expected at most " + Text(longest) + " bytes, got " + Text(value.Length));
            return value;
        }

        public IReadOnlyList<T> List<T>(int longest, Func<WireReader, T> read)
        {
            var list = new List<T>();
            BeginArray();
            while (NextItem())
            {
                if (list.Count == longest) throw Error("expected at most " + Text(longest) + " items");
                list.Add(read(this));
            }
            return list;
        }

        public IReadOnlyDictionary<string, T> Map<T>(int longest, Func<WireReader, T> read)
        {
            var map = new Dictionary<string, T>();
            string key;
            BeginMap();
            while ((key = NextKey()) != null)
            {
                if (map.Count == longest) throw Error("expected at most " + Text(longest) + " entries");
                map[key] = read(this);
            }
            return map;
        }

        /// <summary>Begins an array of so many numbers, to be read with <see cref="Number"/>.</summary>
        public void BeginTuple(int count)
        {
            BeginArray();
            _tuple = count;
        }

        public double Number(double least, double most)
        {
            if (!NextItem()) throw Error("expected " + Text(_tuple) + " numbers, got fewer");
            return Float(least, most);
        }

        public void EndTuple()
        {
            if (!NextItem()) return;
            Leave();
            throw Error("expected " + Text(_tuple) + " numbers, got more");
        }

        /// <summary>Throws for the first required field whose bit is not set.</summary>
        public void Require(uint seen, string[] names)
        {
            for (int bit = 0; bit < names.Length; bit++)
            {
                if ((seen & 1u << bit) != 0) continue;
                string path = Path();
                throw new ProtocolException(path.Length == 0 ? names[bit] : path + "." + names[bit], "is missing");
            }
        }

        public ProtocolException Error(string sentence) => new ProtocolException(Path(), sentence);

        /// <summary>Forgets the message before.</summary>
        protected void Restart()
        {
            Depth = 0;
            Rewind();
        }

        protected void Enter()
        {
            if (Depth == DepthLimit) throw Error("nested deeper than " + Text(DepthLimit));
            Depth++;
            _keys[Depth] = null;
            _items[Depth] = -1;
        }

        protected void Leave()
        {
            Depth--;
        }

        protected string AtKey(string key)
        {
            _keys[Depth] = key;
            return key;
        }

        protected void AtNextItem()
        {
            _items[Depth]++;
        }

        static int CodePoints(string text)
        {
            int count = text.Length;
            foreach (char unit in text)
                if (char.IsLowSurrogate(unit)) count--;
            return count;
        }

        static string Text(long number) => number.ToString(CultureInfo.InvariantCulture);

        static string Text(double number) => number.ToString("R", CultureInfo.InvariantCulture);

        static string Quoted(string text) => "'" + (text.Length > 40 ? text.Substring(0, 40) + "..." : text) + "'";

        string Path()
        {
            var path = new StringBuilder();
            for (int level = 1; level <= Depth; level++)
            {
                if (_keys[level] != null)
                    path.Append(path.Length == 0 ? "" : ".").Append(_keys[level]);
                else if (_items[level] >= 0)
                    path.Append('[').Append(_items[level]).Append(']');
            }
            return path.ToString();
        }
    }
}
