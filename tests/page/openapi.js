// Writes the interface of a served coordinator to a file: node tests/page/openapi.js FILE

import { mkdir, writeFile } from "node:fs/promises";
import { dirname } from "node:path";

import { Service } from "./service.js";

const service = await Service.start();
await mkdir(dirname(process.argv[2]), { recursive: true });
await writeFile(process.argv[2], `${JSON.stringify(await service.get("/openapi.json"), null, 2)}\n`);
await service.stop();
