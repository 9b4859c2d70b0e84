// Words in a PNG: a chunk of international text before its end, as the format has it (PNG, third edition, 11.3.3.4).

function crc(bytes: Uint8Array): number {
  let sum = ~0;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

/** The picture with `key` and `text` in it, by which programs that list metadata show it. */
export async function withText(picture: Blob, key: string, text: string): Promise<Blob> {
  const bytes = new Uint8Array(await picture.arrayBuffer()), words = new TextEncoder().encode(`iTXt${key}\0\0\0\0\0${text}`);  // not compressed, of no language
  const chunk = new Uint8Array(8 + words.length), view = new DataView(chunk.buffer), end = bytes.length - 12;  // IEND is the last, and empty
  view.setUint32(0, words.length - 4);
  chunk.set(words, 4);
  view.setUint32(4 + words.length, crc(words));
  return new Blob([bytes.subarray(0, end), chunk, bytes.subarray(end)], {type: 'image/png'});
}
