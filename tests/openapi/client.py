"""Imports every operation of a generated client: python tests/openapi/client.py FOLDER OPERATIONS

FOLDER has the package `client`; OPERATIONS lists each operation's id, method and path.
"""

import importlib
import pathlib
import sys

folder, operations = sys.argv[1:]
sys.path.insert(0, folder)
modules = {path.stem: path for path in pathlib.Path(folder, "client", "api").glob("*/*.py") if path.stem != "__init__"}
missing = []
for line in pathlib.Path(operations).read_text().splitlines():
    name, method, path = line.split()
    if name not in modules:
        missing.append(f"{name} ({method} {path})")
        continue
    module = importlib.import_module(f"client.api.{modules[name].parent.name}.{name}")
    assert callable(module.sync_detailed) and callable(module.asyncio_detailed), name
assert not missing, f"the generated client lacks {missing}"
print(f"a generated client has {len(modules)} operations")
