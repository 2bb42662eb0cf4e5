using System;
using System.Globalization;
using System.Numerics;

namespace AgentServer
{
    /// <summary>
    /// Doubles as decimal texts, exactly: some runtimes read a number of 17 digits as its neighbour.
    /// </summary>
    static class Decimals
    {
        // More digits than these never matter to the rounding, but that they are not all zero.
        const int DigitLimit = 800;
        const int ExponentLimit = 1000000;
        const int MantissaBits = 53;
        const int LeastExponent = -1074;
        const ulong ExactLimit = 1UL << MantissaBits;

        static readonly double[] Powers =
        {
            1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
            1e19, 1e20, 1e21, 1e22,
        };

        /// <summary>A text of 15 digits if that reads back as the same number, else of 16 or 17.</summary>
        public static string Write(double value)
        {
            foreach (string format in new[] { "G15", "G16" })
            {
                string text = value.ToString(format, CultureInfo.InvariantCulture);
                double back;
                if (TryRead(text, out back) && back == value) return text;
            }
            return value.ToString("G17", CultureInfo.InvariantCulture);
        }

        /// <summary>Reads a number of JSON; false if it is too large for a double.</summary>
        public static bool TryRead(string text, out double value)
        {
            bool isNegative = text[0] == '-';
            int at = isNegative ? 1 : 0;
            int exponent = 0;
            int digits = 0;
            bool isFraction = false;
            var kept = new char[Math.Min(text.Length, DigitLimit) + 1];
            for (; at < text.Length && text[at] != 'e' && text[at] != 'E'; at++)
            {
                if (text[at] == '.')
                {
                    isFraction = true;
                    continue;
                }
                if (isFraction) exponent--;
                if (digits == 0 && text[at] == '0') continue;
                if (digits < DigitLimit) kept[digits++] = text[at];
                else
                {
                    exponent++;
                    if (text[at] != '0') kept[DigitLimit - 1] = '1';
                }
            }
            if (at < text.Length) exponent += Exponent(text, at + 1);
            double size = digits == 0 ? 0 : Nearest(new string(kept, 0, digits), exponent);
            value = isNegative ? -size : size;
            return !double.IsInfinity(size);
        }

        static int Exponent(string text, int at)
        {
            bool isNegative = text[at] == '-';
            if (isNegative || text[at] == '+') at++;
            int exponent = 0;
            for (; at < text.Length; at++) exponent = Math.Min(10 * exponent + (text[at] - '0'), ExponentLimit);
            return isNegative ? -exponent : exponent;
        }

        /// <summary>The double nearest to digits * 10^exponent; infinity if that is too large.</summary>
        static double Nearest(string digits, int exponent)
        {
            if (digits.Length <= 19 && Math.Abs(exponent) < Powers.Length)
            {
                ulong number = ulong.Parse(digits, NumberStyles.None, CultureInfo.InvariantCulture);
                // Both are doubles as they stand, so that one operation rounds once.
                if (number <= ExactLimit)
                    return exponent < 0 ? number / Powers[-exponent] : number * Powers[exponent];
            }
            if (digits.Length + exponent > 310) return double.PositiveInfinity;
            if (digits.Length + exponent < -330) return 0;
            BigInteger above = BigInteger.Parse(digits, NumberStyles.None, CultureInfo.InvariantCulture);
            BigInteger below = BigInteger.One;
            if (exponent >= 0) above *= BigInteger.Pow(10, exponent);
            else below = BigInteger.Pow(10, -exponent);
            return Nearest(above, below);
        }

        /// <summary>The double nearest to a fraction.</summary>
        static double Nearest(BigInteger above, BigInteger below)
        {
            // A quotient of 55 to 72 bits: more than a mantissa and the bit behind it.
            int shift = 63 - 8 * (above.ToByteArray().Length - below.ToByteArray().Length);
            if (shift >= 0) above <<= shift;
            else below <<= -shift;
            BigInteger rest;
            BigInteger quotient = BigInteger.DivRem(above, below, out rest);
            int drop = Math.Max(Bits(quotient) - MantissaBits, LeastExponent + shift);
            BigInteger unit = BigInteger.One << drop;
            BigInteger remainder;
            ulong mantissa = (ulong)BigInteger.DivRem(quotient, unit, out remainder);
            int half = (2 * remainder).CompareTo(unit);
            if (half > 0 || half == 0 && (!rest.IsZero || mantissa % 2 == 1)) mantissa++;
            return Assembled(mantissa, drop - shift);
        }

        static double Assembled(ulong mantissa, int exponent)
        {
            if (mantissa == ExactLimit)
            {
                mantissa >>= 1;
                exponent++;
            }
            if (mantissa < ExactLimit / 2) return BitConverter.Int64BitsToDouble((long)mantissa);
            int biased = exponent - LeastExponent + 1;
            if (biased >= 2047) return double.PositiveInfinity;
            return BitConverter.Int64BitsToDouble((long)biased << 52 | (long)(mantissa & ExactLimit / 2 - 1));
        }

        static int Bits(BigInteger number)
        {
            byte[] bytes = number.ToByteArray();
            int bits = 8 * (bytes.Length - 1);
            for (int top = bytes[bytes.Length - 1]; top != 0; top >>= 1) bits++;
            return bits;
        }
    }
}
