/** The room's palette: pale wood, white, a quiet green, dark instruments. */

export const OAK = 0xd2a673;
export const WALNUT = 0x8a5a38;
export const BLACK = 0x22252a;
export const IRON = 0x4a4d52;
export const STEEL = 0xb8bcc0;
export const SAGE = 0x7d9084;
export const WHITE = 0xf1efe9;
