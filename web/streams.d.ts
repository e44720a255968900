// SPDX-License-Identifier: BSD-3-Clause
// Of browsers, but not yet in the declarations of TypeScript 4.8.
declare class CompressionStream {
  constructor(format: "deflate-raw");
  readonly readable: ReadableStream;
  readonly writable: WritableStream;
}
declare class DecompressionStream extends CompressionStream {}
