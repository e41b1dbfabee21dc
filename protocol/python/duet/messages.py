"""The messages of protocol/proto, compiled by protoc when this module is imported.

So there is one schema and no generated file to keep in step with it; protoc takes some ten
milliseconds. `v1` holds a class for each top-level message, by its name.
"""

import pathlib
import shutil
import subprocess
import sys
import types

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

PROTO = pathlib.Path(__file__).resolve().parents[2] / "proto"
PACKAGE = "duet.v1"


def _compile():
    protoc = shutil.which("protoc")
    if protoc is None:
        sys.exit("duet: protoc is not installed; install the package protobuf-compiler.")
    run = subprocess.run(
        [protoc, "--include_imports", "--descriptor_set_out=/dev/stdout", "-I", PROTO,
         "duet/v1/coupling.proto"], capture_output=True, check=False)
    if run.returncode != 0:
        sys.exit(f"duet: protoc cannot compile {PROTO}: {run.stderr.decode()}")
    return descriptor_pb2.FileDescriptorSet.FromString(run.stdout)


def _message_class(descriptor):
    if hasattr(message_factory, "GetMessageClass"):  # protobuf 4.22 and later
        return message_factory.GetMessageClass(descriptor)
    return message_factory.MessageFactory(descriptor_pool.Default()).GetPrototype(descriptor)


def _load():
    pool = descriptor_pool.Default()
    classes = types.SimpleNamespace()
    for file in _compile().file:
        if file.package != PACKAGE:
            continue  # descriptor.proto is in the default pool already
        pool.AddSerializedFile(file.SerializeToString())
        for name in [message.name for message in file.message_type]:
            descriptor = pool.FindMessageTypeByName(f"{PACKAGE}.{name}")
            setattr(classes, name, _message_class(descriptor))
        for enum in file.enum_type:
            for value in enum.value:
                setattr(classes, value.name, value.number)
    return classes


v1 = _load()
