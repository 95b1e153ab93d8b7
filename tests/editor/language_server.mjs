// The YAML language server, driven as by an editor: over the Language Server Protocol on standard
// input and output. The environment gives the paths: QSMPC_PROGRAM, QSMPC_SOURCE and
// QSMPC_NODE_MODULES.
import {execFileSync, spawn} from "node:child_process";
import {existsSync, mkdtempSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";

const required = (name) => {
  if (!process.env[name]) throw new Error(`${name} is not set`);
  return process.env[name];
};

export const source = required("QSMPC_SOURCE");

export const qsmpc = (...words) =>
  execFileSync(required("QSMPC_PROGRAM"), words, {encoding: "utf8", stdio: ["ignore", "pipe", "pipe"]});

// File kinds with a schema; a document of a kind is called *.KIND.yaml here.
const kinds = ["scenario", "campaign", "contest"];

// { kind: address } of the schemas printed by the program.
function writeSchemas() {
  const folder = mkdtempSync(join(tmpdir(), "qsmpc_editor_"));
  return kinds.map((kind) => {
    const path = join(folder, `qsmpc-${kind}.schema.json`);
    writeFileSync(path, qsmpc("schema", kind));
    return [pathToFileURL(path).href, `*.${kind}.yaml`];
  });
}

export class LanguageServer {
  constructor() {
    const program = join(required("QSMPC_NODE_MODULES"), "yaml-language-server/bin/yaml-language-server");
    if (!existsSync(program)) throw new Error(`no ${program}; scripts/test builds editor_tools, which fetches it`);
    this.settings = {
      yaml: {validate: true, hover: true, schemaStore: {enable: false}, schemas: Object.fromEntries(writeSchemas())},
    };
    this.process = spawn(process.execPath, [program, "--stdio"], {stdio: ["pipe", "pipe", "inherit"]});
    this.received = Buffer.alloc(0);
    this.answers = new Map();
    this.diagnostics = new Map();
    this.lastId = 0;
    this.process.stdout.on("data", (data) => this.read(data));
  }

  async start() {
    await this.request("initialize", {
      processId: process.pid,
      rootUri: null,
      capabilities: {workspace: {configuration: true}, textDocument: {hover: {contentFormat: ["markdown"]}}},
    });
    this.notify("initialized", {});
    this.notify("workspace/didChangeConfiguration", {settings: this.settings});
  }

  async stop() {
    await this.request("shutdown", null);
    this.notify("exit", null);
  }

  // The server's diagnostics of `text` as a file of the kind: [{line, message}], lines counted from
  // 1.
  async diagnose(kind, text) {
    const uri = this.open(kind, text);
    const found = await new Promise((resolve) => this.diagnostics.set(uri, resolve));
    this.notify("textDocument/didClose", {textDocument: {uri}});
    return found.map(({range, message}) => ({line: range.start.line + 1, message}));
  }

  // The server's hover text of a key. Lines are counted from 1.
  async hover(kind, text, line, character) {
    const uri = this.open(kind, text);
    await new Promise((resolve) => this.diagnostics.set(uri, resolve));
    const shown = await this.request("textDocument/hover", {
      textDocument: {uri},
      position: {line: line - 1, character},
    });
    return shown?.contents.value ?? "";
  }

  open(kind, text) {
    this.documents = (this.documents ?? 0) + 1;
    const uri = `file:///documents/d${this.documents}.${kind}.yaml`;
    this.notify("textDocument/didOpen", {textDocument: {uri, languageId: "yaml", version: 1, text}});
    return uri;
  }

  request(method, params) {
    const id = ++this.lastId;
    this.send({jsonrpc: "2.0", id, method, params});
    return new Promise((resolve, reject) => this.answers.set(id, {resolve, reject}));
  }

  notify(method, params) {
    this.send({jsonrpc: "2.0", method, params});
  }

  send(message) {
    const body = Buffer.from(JSON.stringify(message));
    this.process.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
    this.process.stdin.write(body);
  }

  read(data) {
    this.received = Buffer.concat([this.received, data]);
    for (;;) {
      const end = this.received.indexOf("\r\n\r\n");
      if (end < 0) return;
      const length = Number(/Content-Length: (\d+)/i.exec(this.received.subarray(0, end).toString())[1]);
      if (this.received.length < end + 4 + length) return;
      const body = this.received.subarray(end + 4, end + 4 + length).toString();
      this.received = this.received.subarray(end + 4 + length);
      this.handle(JSON.parse(body));
    }
  }

  handle(message) {
    if (message.method === "workspace/configuration") {
      const result = message.params.items.map(({section}) => this.settings[section] ?? {});
      this.send({jsonrpc: "2.0", id: message.id, result});
    } else if (message.method === "textDocument/publishDiagnostics") {
      this.diagnostics.get(message.params.uri)?.(message.params.diagnostics);
      this.diagnostics.delete(message.params.uri);
    } else if (message.method && message.id !== undefined) {
      this.send({jsonrpc: "2.0", id: message.id, result: null});
    } else if (this.answers.has(message.id)) {
      const {resolve, reject} = this.answers.get(message.id);
      this.answers.delete(message.id);
      if (message.error) reject(new Error(message.error.message));
      else resolve(message.result);
    }
  }
}
