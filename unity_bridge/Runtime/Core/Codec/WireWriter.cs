using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>Writes a message value by value, whatever its coding.</summary>
    abstract class WireWriter
    {
        /// <summary>Name of the field that is being written.</summary>
        protected string Field { get; private set; } = "";

        public void BeginMap(int count) => BeginMap(count, count);

        /// <summary>Begins a map of so many entries, which could have been up to `most`.</summary>
        public abstract void BeginMap(int count, int most);

        public abstract void EndMap();

        public abstract void BeginArray(int count);

        /// <summary>Says that an item of an array follows.</summary>
        public abstract void Item();

        public abstract void EndArray();

        public abstract void Null();

        public abstract void Bool(bool value);

        public abstract void Int(long value);

        public abstract void Bytes(byte[] value);

        protected abstract void FiniteFloat(double value);

        protected abstract void AnyStr(string value);

        protected abstract void AnyKey(string key);

        public void Key(string key)
        {
            Field = key;
            AnyKey(key);
        }

        public void Float(double value)
        {
            if (double.IsNaN(value) || double.IsInfinity(value))
                throw new ProtocolException(Field, "is not a finite number and cannot be sent");
            FiniteFloat(value);
        }

        public void Str(string value)
        {
            if (value == null) throw new ProtocolException(Field, "has a null, where a text belongs");
            AnyStr(value);
        }

        public void List<T>(IReadOnlyList<T> list, Action<WireWriter, T> write)
        {
            BeginArray(list.Count);
            for (int index = 0; index < list.Count; index++)
            {
                Item();
                write(this, list[index]);
            }
            EndArray();
        }

        public void Map<T>(IReadOnlyDictionary<string, T> map, Action<WireWriter, T> write)
        {
            BeginMap(map.Count);
            foreach (KeyValuePair<string, T> entry in map)
            {
                Key(entry.Key);
                write(this, entry.Value);
            }
            EndMap();
        }
    }
}
