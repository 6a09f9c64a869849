// A coordinator with one local worker on a free port, with a store of its own.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, readdir, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

const PROGRAM = process.env.COORDINATOR ?? "target/release/coordinator";
const LOOK_MS = 100;
const START_MS = 60_000;

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = server.address();
  server.close();
  await once(server, "close");
  return port;
}

/** Runs the coordinator to its end and returns what it prints. */
export async function coordinator(...parameters) {
  const child = spawn(PROGRAM, parameters, { stdio: ["ignore", "pipe", "pipe"] });
  let out = "",
    errors = "";
  child.stdout.on("data", (text) => (out += text));
  child.stderr.on("data", (text) => (errors += text));
  const [code] = await once(child, "close");
  if (code !== 0) throw new Error(`coordinator ${parameters.join(" ")} exits ${code}: ${errors}`);
  return out;
}

export class Service {
  /** Starts a service on an empty store; with `tokenOf`, it asks for a token, which `token` then holds. */
  static async start({ tokenOf = null } = {}) {
    const service = new Service();
    service.folder = await mkdtemp(join(tmpdir(), "page-"));
    service.store = `sqlite://${join(service.folder, "store.db")}`;
    if (tokenOf) {
      const text = await coordinator("token", "add", tokenOf, "--role", "submit", "--store", service.store);
      service.token = text.match(/\S{24,}/)[0];
    }
    service.port = await freePort();
    service.url = `http://127.0.0.1:${service.port}`;
    await service.restart();
    return service;
  }

  /** Starts it (again) on the same port and store. */
  async restart() {
    this.child = spawn(
      PROGRAM,
      ["serve", "--listen", `127.0.0.1:${this.port}`, "--store", this.store, "--local-workers", "1"],
      { stdio: "ignore" },
    );
    for (const end = Date.now() + START_MS; ; await sleep(LOOK_MS)) {
      if (
        await fetch(`${this.url}/openapi.json`).then(
          (r) => r.status < 500,
          () => false,
        )
      )
        return;
      if (Date.now() > end) throw new Error(`the coordinator does not answer after ${START_MS} ms`);
    }
  }

  /** Ends it at once, as a power cut does. */
  async kill() {
    this.child.kill("SIGKILL");
    await once(this.child, "exit");
  }

  async stop() {
    if (this.child.exitCode === null && this.child.signalCode === null) await this.kill();
    await rm(this.folder, { recursive: true, force: true });
  }

  async get(path) {
    const response = await fetch(this.url + path);
    if (!response.ok) throw new Error(`GET ${path}: ${response.status} ${await response.text()}`);
    return response.json();
  }

  async post(path, body) {
    const response = await fetch(this.url + path, {
      method: "POST",
      headers: { "content-type": "application/json" },
      body: JSON.stringify(body),
    });
    if (!response.ok) throw new Error(`POST ${path}: ${response.status} ${await response.text()}`);
    return response.json();
  }

  /** Waits until a study is over and returns it. */
  async finished(id, withinMs = 600_000) {
    for (const end = Date.now() + withinMs; ; await sleep(LOOK_MS)) {
      const study = await this.get(`/v1/studies/${id}`);
      if (["finished", "failed", "cancelled"].includes(study.state)) return study;
      if (Date.now() > end) throw new Error(`study ${id} is ${study.state} after ${withinMs} ms`);
    }
  }
}

/** The files of an example as the page takes them, with `edit(text of the job)` in place of the job. */
export async function filesOf(folder, edit = (job) => job, names = null) {
  const all = names ?? (await readdir(folder)).filter((name) => /\.(toml|csv)$/.test(name));
  return Promise.all(
    all.map(async (name) => {
      const text = await readFile(join(folder, name), "utf8");
      return { name: basename(name), mimeType: "text/plain", text: name === "job.toml" ? edit(text) : text };
    }),
  );
}
