// SPDX-License-Identifier: MIT
// Packed arrays, unpacked when they are first looked at.

function decodeBase64(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

// The numbers of a PackedArray (packed_array.h); of bits, their bytes.
function unpack(packed) {
  const bytes = decodeBase64(packed.base64);
  if (packed.type === "bits") return bytes;
  if (packed.type === "f32") return new Float32Array(bytes.buffer);
  const raw = new Uint16Array(bytes.buffer);
  const numbers = new Float32Array(raw.length);
  for (let i = 0; i < raw.length; ++i) {
    numbers[i] = raw[i] === 65535 ? NaN : raw[i] * packed.scale + packed.offset;
  }
  return numbers;
}

// Gives `owner` a property that is unpacked at its first use.
function lazily(owner, name, packed) {
  Object.defineProperty(owner, name, {
    configurable: true,
    get() {
      const numbers = packed ? unpack(packed) : null;
      Object.defineProperty(owner, name, {value: numbers});
      return numbers;
    },
  });
}
