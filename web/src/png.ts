// A word in a PNG: a chunk of text before its end, as the format has it (PNG, third edition, 11.3.3.2).

function crc(bytes: Uint8Array): number {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

/** The picture with `key` and `text` in it; characters beyond Latin-1 become question marks, as the chunk asks. */
export async function withText(picture: Blob, key: string, text: string): Promise<Blob> {
  const bytes = new Uint8Array(await picture.arrayBuffer()), latin = [...`${key}\0${text}`].map((letter) => (letter.charCodeAt(0) < 256 ? letter.charCodeAt(0) : 63));
  const chunk = new Uint8Array(12 + latin.length), view = new DataView(chunk.buffer), end = bytes.length - 12;  // IEND is the last, and empty
  view.setUint32(0, latin.length);
  chunk.set([0x74, 0x45, 0x58, 0x74], 4);  // tEXt
  chunk.set(latin, 8);
  view.setUint32(8 + latin.length, crc(chunk.subarray(4, 8 + latin.length)));
  return new Blob([bytes.subarray(0, end), chunk, bytes.subarray(end)], {type: 'image/png'});
}
