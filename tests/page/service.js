// A coordinator with its own store and one local worker; it can be killed and started again in its place.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";

export const PROGRAM = process.env.COORDINATOR ?? "target/release/coordinator";

const freePort = () => new Promise((resolve) => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => resolve(port));
  });
});

/** Runs the program to its end; what it prints. */
export function command(words, options = {}) {
  const { status, stdout, stderr } = spawnSync(PROGRAM, words, { encoding: "utf8", ...options });
  if (status !== 0) throw new Error(`coordinator ${words.join(" ")}: ${stderr}`);
  return stdout;
}

export class Service {
  static async start() {
    const service = new Service();
    service.folder = mkdtempSync(join(tmpdir(), "page-"));
    service.store = `sqlite://${join(service.folder, "grouser.db")}`;
    service.port = await freePort();
    await service.spawn();
    return service;
  }

  get url() {
    return `http://127.0.0.1:${this.port}/`;
  }

  async spawn() {
    const words = ["serve", "--listen", `127.0.0.1:${this.port}`, "--store", this.store, "--local-workers", "1"];
    this.process = spawn(PROGRAM, words, { stdio: "ignore" });
    for (let look = 0; look < 200; look += 1) {
      if (await fetch(`${this.url}health`).then((r) => r.ok, () => false)) return;
      await sleep(50);
    }
    throw new Error("the coordinator does not answer");
  }

  /** As a power cut would end it. */
  async kill() {
    const ended = new Promise((resolve) => this.process.once("exit", resolve));
    this.process.kill("SIGKILL");
    await ended;
  }

  async stop() {
    await this.kill();
    rmSync(this.folder, { recursive: true });
  }

  async json(path) {
    return (await fetch(this.url + path.replace(/^\//, ""))).json();
  }
}
