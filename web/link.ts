// SPDX-License-Identifier: BSD-3-Clause
// The page's line to the server, taken up again whenever it breaks.

export interface Incoming {
  kind: string;
  id?: number;
  [key: string]: any;
}

export interface LinkListener {
  opened(): void;
  lost(): void;
  message(message: Incoming, bytes: Uint8Array | null): void;
}

/** A file that was dropped, with what the server is told of it: each connection has a bench of its own, which must be given it anew. */
export interface Dropped {
  header: {kind: "upload"; id: number; name: string};
  bytes: Blob;
}

const protocol = "petzval-live.1";

export class Link {
  private socket: WebSocket | null = null;
  private wait_ms = 250;
  private closed = false;

  constructor(private readonly token: string, private readonly listener: LinkListener) { this.open(); }

  get isOpen(): boolean { return this.socket?.readyState === WebSocket.OPEN; }

  send(message: object): void {
    if (this.isOpen) this.socket!.send(JSON.stringify(message));
  }

  /** For good. */
  close(): void {
    this.closed = true;
    this.socket?.close();
  }

  /** A file, behind a header that says what it is. */
  async upload({header, bytes: file}: Dropped): Promise<void> {
    const text = new TextEncoder().encode(JSON.stringify(header)), bytes = await file.arrayBuffer();
    const frame = new Uint8Array(4 + text.length + bytes.byteLength);
    new DataView(frame.buffer).setUint32(0, text.length, true);
    frame.set(text, 4);
    frame.set(new Uint8Array(bytes), 4 + text.length);
    if (this.isOpen) this.socket!.send(frame);
  }

  private open(): void {
    const socket = new WebSocket(`ws://${location.host}/bench`, [protocol, this.token]);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.wait_ms = 250;
      this.listener.opened();
    };
    socket.onmessage = event => this.take(event.data);
    socket.onclose = () => {
      this.socket = null;
      if (this.closed) return;
      this.listener.lost();
      setTimeout(() => { if (!this.closed) this.open(); }, this.wait_ms);
      const longest_ms = 3000;
      this.wait_ms = Math.min(longest_ms, this.wait_ms * 1.5);
    };
    this.socket = socket;
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data === "string") return this.listener.message(JSON.parse(data), null);
    const length = new DataView(data).getUint32(0, true);
    const header = new TextDecoder().decode(new Uint8Array(data, 4, length));
    this.listener.message(JSON.parse(header), new Uint8Array(data, 4 + length));
  }
}

/** The token: of the address if it is there, which then forgets it, else of this tab's or an earlier page of the same server. */
export function takeToken(): string {
  const parts = new URLSearchParams(location.hash.slice(1));
  const token = parts.get("token");
  if (token) {
    localStorage.setItem("petzval-token", token);
    parts.delete("token");
    history.replaceState(null, "", parts.toString() ? `#${parts}` : location.pathname);
    return token;
  }
  return localStorage.getItem("petzval-token") ?? "";
}
