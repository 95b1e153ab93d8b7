// Numbers as data.js and packed_numbers.hpp have them.

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

export const floatsOf = (text) => new Float32Array(bytesOf(text).buffer);
export const wordsOf = (text) => new Uint16Array(bytesOf(text).buffer);
