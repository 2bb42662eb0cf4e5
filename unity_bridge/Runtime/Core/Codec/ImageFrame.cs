using System;

namespace AgentServer
{
    /// <summary>
    /// An image in the JSON coding, where it is binary: `AFJ1`, four bytes of flags (0), originating_ns
    /// in eight, both little-endian, and the JPEG.
    /// </summary>
    static class ImageFrame
    {
        const int HeaderBytes = 16;
        const long MaxStampNs = 9007199254740991;

        static readonly byte[] Magic = { (byte)'A', (byte)'F', (byte)'J', (byte)'1' };

        public static byte[] Write(Image image)
        {
            var data = new byte[HeaderBytes + image.Jpeg.Length];
            Buffer.BlockCopy(Magic, 0, data, 0, Magic.Length);
            for (int index = 0; index < 8; index++)
                data[8 + index] = (byte)(image.OriginatingNs >> 8 * index);
            Buffer.BlockCopy(image.Jpeg, 0, data, HeaderBytes, image.Jpeg.Length);
            return data;
        }

        public static Image Read(byte[] data)
        {
            for (int index = 0; index < Magic.Length; index++)
                if (index >= data.Length || data[index] != Magic[index])
                    throw new ProtocolException("", "binary in the JSON coding, without the AFJ1 of an image");
            if (data.Length <= HeaderBytes) throw new ProtocolException("", "the image has no JPEG");
            if ((data[4] | data[5] | data[6] | data[7]) != 0)
                throw new ProtocolException("flags", "none is defined: expected 0");
            long stamp = 0;
            for (int index = 7; index >= 0; index--) stamp = stamp << 8 | data[8 + index];
            if (stamp < 0 || stamp > MaxStampNs)
                throw new ProtocolException("originating_ns", "expected nanoseconds from 0 to " + MaxStampNs);
            var jpeg = new byte[data.Length - HeaderBytes];
            Buffer.BlockCopy(data, HeaderBytes, jpeg, 0, jpeg.Length);
            return new Image(stamp, jpeg);
        }
    }
}
