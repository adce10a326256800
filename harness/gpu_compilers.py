#!/usr/bin/env python3
"""Compiles every kernel for GPUs without a GPU and reports registers, spills, waves, instructions and latency.

Links each kernel as for a scene on a GPU (harness/kit/examples/gpu_kernels.rs) and compiles it with RADV, Mesa's
driver for AMD, which creates pipelines for chips that are not present. Prints a table and compares it with the record;
fails on any spill, on fewer waves, and on more than 5 % more instructions.

    harness/gpu_compilers.py [--keep] [--kernels FOLDER] [--isa FOLDER] [PATTERN]

--keep writes the record; --kernels replaces files of the library by those of a folder; --isa writes the machine code
of each kernel; PATTERN selects kernels by name, as in step_*.
"""
import argparse
import concurrent.futures
import ctypes as c
import fnmatch
import glob
import json
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TARGET = os.path.join(ROOT, os.environ.get("CARGO_TARGET_DIR", "target"))
RECORD = os.path.join(ROOT, "harness/results/gpu_compilers.json")
# RDNA2, RDNA3, and GCN, the predecessor of CDNA.
CHIPS = ["NAVI21", "NAVI31", "VEGA20"]
# Statistics in the record, with their names in the driver; spills are the sum over both kinds of registers.
KEPT = {"registers": "VGPRs", "waves": "Subgroups per SIMD", "instructions": "Instructions", "latency": "Latency"}
SPILLS = ("Spilled VGPRs", "Spilled SGPRs")
MOST_INSTRUCTIONS = 1.05


def struct(kind, *fields):
    """Constructor of a Vulkan structure with the given fields after sType and pNext."""
    own = [("sType", c.c_uint32), ("pNext", c.c_void_p), *fields]
    made = type("Made", (c.Structure,), {"_fields_": own})
    return lambda **values: made(sType=kind, **values)


U32, PTR, STR = c.c_uint32, c.c_void_p, c.c_char_p
application_info = struct(0, ("a", STR), ("b", U32), ("e", STR), ("f", U32), ("apiVersion", U32))
instance_info = struct(1, ("flags", U32), ("application", PTR), ("layers", U32), ("l", PTR), ("extensions", U32), ("x", PTR))
queue_info = struct(2, ("flags", U32), ("family", U32), ("count", U32), ("priorities", PTR))
device_info = struct(3, ("flags", U32), ("queues", U32), ("queue", PTR), ("layers", U32), ("l", PTR),
                     ("extensions", U32), ("names", PTR), ("features", PTR))
module_info = struct(16, ("flags", U32), ("size", c.c_size_t), ("code", STR))
STAGE = [("sType", U32), ("pNext", PTR), ("flags", U32), ("stage", U32), ("module", c.c_uint64), ("entry", STR), ("special", PTR)]
Stage = type("Stage", (c.Structure,), {"_fields_": STAGE})
pipeline_info = struct(29, ("flags", U32), ("stage", Stage), ("layout", c.c_uint64), ("base", c.c_uint64), ("index", c.c_int32))
layout_info = struct(30, ("flags", U32), ("sets", U32), ("set", PTR), ("ranges", U32), ("range", PTR))
set_info = struct(32, ("flags", U32), ("count", U32), ("bindings", PTR))
Binding = type("Binding", (c.Structure,), {"_fields_": [("n", U32), ("kind", U32), ("count", U32), ("stages", U32), ("samplers", PTR)]})
executable_feature = struct(1000269000, ("on", U32))
robustness_feature = struct(1000286000, ("buffer", U32), ("image", U32), ("null", U32))
of_pipeline = struct(1000269001, ("pipeline", c.c_uint64))
of_executable = struct(1000269003, ("pipeline", c.c_uint64), ("index", U32))
TEXT = c.c_char * 256
Statistic = type("Statistic", (c.Structure,), {"_fields_": [
    ("sType", U32), ("pNext", PTR), ("name", TEXT), ("description", TEXT), ("format", U32), ("value", c.c_uint64)]})
Representation = type("Representation", (c.Structure,), {"_fields_": [
    ("sType", U32), ("pNext", PTR), ("name", TEXT), ("description", TEXT), ("is_text", U32), ("size", c.c_size_t), ("data", PTR)]})
COMPUTE = 0x20
UNIFORM, STORAGE = 6, 7


class Driver:
    """RADV, called as the Vulkan loader calls it, for the chip that RADV_FORCE_FAMILY names."""

    def __init__(self, library):
        self.get = c.CDLL(library).vk_icdGetInstanceProcAddr
        self.get.restype, self.get.argtypes = PTR, (PTR, STR)
        self.instance = None
        application = application_info(apiVersion=1 << 22 | 3 << 12)
        self.instance = self.made("vkCreateInstance", instance_info(application=c.addressof(application)), handle=PTR)
        count, physical = U32(1), PTR()
        self.call("vkEnumeratePhysicalDevices", PTR(self.instance), c.byref(count), c.byref(physical))
        properties = (c.c_uint32 * 1024)()
        self.call("vkGetPhysicalDeviceProperties", physical, c.byref(properties), check=False)
        v = properties[1]
        self.version = f"RADV of Mesa {v >> 22}.{v >> 12 & 1023}.{v & 4095}"
        priority = c.c_float(1.0)
        queue = queue_info(count=1, priorities=c.addressof(priority))
        robust = robustness_feature(buffer=1, image=1)
        executable = executable_feature(on=1, pNext=c.addressof(robust))
        features = (U32 * 55)(1)  # robustBufferAccess
        names = (STR * 2)(b"VK_KHR_pipeline_executable_properties", b"VK_EXT_robustness2")
        info = device_info(pNext=c.addressof(executable), queues=1, queue=c.addressof(queue), extensions=2,
                           names=c.addressof(names), features=c.addressof(features))
        self.device = self.made("vkCreateDevice", info, of=physical, handle=PTR)

    def call(self, name, *arguments, check=True):
        function = c.CFUNCTYPE(c.c_int)(self.get(self.instance, name.encode()))
        function.argtypes = None
        result = function(*arguments)
        if check and result < 0:
            raise OSError(f"{name}: VkResult {result}")

    def made(self, name, info, of=None, handle=c.c_uint64):
        result = handle()
        first = [] if name == "vkCreateInstance" else [of or PTR(self.device)]
        self.call(name, *first, c.byref(info), None, c.byref(result))
        return result.value

    def list(self, name, of, kind, number):
        """The items of a Vulkan function that is called twice, for the count and for the items."""
        count = U32()
        self.call(name, PTR(self.device), c.byref(of), c.byref(count), None)
        items = (kind * count.value)(*[kind(sType=number) for _ in range(count.value)])
        self.call(name, PTR(self.device), c.byref(of), c.byref(count), items)
        return items

    def compile(self, code, entry, bindings, isa):
        """The statistics of a kernel, by their names in the driver, and its machine code if `isa` is set."""
        bound = (Binding * len(bindings))(*[
            Binding(n, UNIFORM if uniform else STORAGE, 1, COMPUTE, None) for n, uniform in bindings])
        sets = c.c_uint64(self.made("vkCreateDescriptorSetLayout", set_info(count=len(bindings), bindings=c.addressof(bound))))
        layout = self.made("vkCreatePipelineLayout", layout_info(sets=1, set=c.addressof(sets)))
        module = self.made("vkCreateShaderModule", module_info(size=len(code), code=code))
        stage = Stage(18, None, 0, COMPUTE, module, entry.encode(), None)
        flags = 0x40 | (0x80 if isa else 0)
        info, pipeline = pipeline_info(flags=flags, stage=stage, layout=layout), c.c_uint64()
        self.call("vkCreateComputePipelines", PTR(self.device), c.c_uint64(0), U32(1), c.byref(info), None, c.byref(pipeline))
        of = of_executable(pipeline=pipeline.value)
        statistics = self.list("vkGetPipelineExecutableStatisticsKHR", of, Statistic, 1000269004)
        text = ""
        if isa:
            name = "vkGetPipelineExecutableInternalRepresentationsKHR"
            made = self.list(name, of, Representation, 1000269005)
            buffers = [c.create_string_buffer(r.size + 1) for r in made]
            for r, buffer in zip(made, buffers):
                r.data, r.size = c.addressof(buffer), len(buffer)
            self.call(name, PTR(self.device), c.byref(of), c.byref(U32(len(made))), made)
            text = buffers[-1].value.decode(errors="replace")
        return {s.name.decode(): s.value for s in statistics}, text


def chip_main(library, folder, chip, pattern, isa):
    """Compiles for one chip, in a process of its own; prints the version and the rows as JSON."""
    driver = Driver(library)
    with open(os.path.join(folder, "index.json")) as file:
        index = json.load(file)
    rows = {}
    for name, kernel in sorted(index.items()):
        if not fnmatch.fnmatch(name, pattern):
            continue
        with open(os.path.join(folder, name + ".spv"), "rb") as file:
            found, text = driver.compile(file.read(), kernel["entry"], kernel["bindings"], isa)
        if isa:
            with open(os.path.join(isa, f"{name}.{chip}.txt"), "w") as file:
                file.write(text)
        rows[name] = {kept: found[theirs] for kept, theirs in KEPT.items()}
        rows[name]["spills"] = sum(found[kind] for kind in SPILLS)
    json.dump({"driver": driver.version, "rows": rows}, sys.stdout)
    sys.stdout.flush()
    os._exit(0)  # Skips the teardown of the device, which has no hardware.


# Downloads packages and installs nothing; RADV also needs the libraries that are installed with lavapipe.
UNPACK = """
printf 'deb http://deb.debian.org/debian bookworm-backports main\\n' >list
mkdir -p lists/partial
apt() {
    apt-get -qq -o Dir::Etc::SourceList="$PWD/list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$PWD/lists" \\
        -o Dir::Cache="$PWD" -o APT::Sandbox::User=root -o Acquire::Languages=none "$@"
}
apt update
apt download mesa-vulkan-drivers/bookworm-backports libdrm-amdgpu1/bookworm-backports libdrm2/bookworm-backports
for package in *.deb; do dpkg -x "$package" .; done
"""


def radv():
    """Path of the driver's library from Debian, the same version on all machines, unpacked into the target folder; None if
    it cannot be downloaded or loaded."""
    unpacked = os.path.join(TARGET, "radv")
    library = unpacked + "/usr/lib/*/libvulkan_radeon.so"
    if not glob.glob(library):
        os.makedirs(unpacked, exist_ok=True)
        subprocess.run(["sh", "-ec", UNPACK], cwd=unpacked, stdout=subprocess.DEVNULL)
    for found in glob.glob(library):
        load = [sys.executable, "-c", "import ctypes, sys; ctypes.CDLL(sys.argv[1])", found]
        if subprocess.run(load, env=environment(found)).returncode == 0:
            return found
    return None


def environment(library, **more):
    near = f"{os.path.dirname(library)}:{os.environ.get('LD_LIBRARY_PATH', '')}"
    return dict(os.environ, LD_LIBRARY_PATH=near, MESA_SHADER_CACHE_DISABLE="true", **more)


def compiled(library, folder, chip, pattern, isa):
    command = [sys.executable, __file__, "--chip", chip, library, folder, pattern, isa or ""]
    done = subprocess.run(command, env=environment(library, RADV_FORCE_FAMILY=chip), capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{chip}: {done.stderr}")
    return json.loads(done.stdout)


def worse(name, chip, now, before):
    """Failures of the comparison with the record."""
    where = f"{name} on {chip}"
    if now["spills"] > 0:
        yield f"{where}: {now['spills']} registers are spilled"
    if before and now["waves"] < before["waves"]:
        yield f"{where}: {now['waves']} waves instead of {before['waves']}"
    if before and now["instructions"] > MOST_INSTRUCTIONS * before["instructions"]:
        yield f"{where}: {now['instructions']} instructions instead of {before['instructions']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--kernels")
    parser.add_argument("--isa")
    parser.add_argument("pattern", nargs="?", default="*")
    arguments = parser.parse_args()
    library = radv()
    if not library:
        print("RADV IS NOT HERE and cannot be downloaded: what GPU compilers make of the kernels is NOT CHECKED", file=sys.stderr)
        return 0
    folder = os.path.join(TARGET, "gpu_kernels")
    shutil.rmtree(folder, ignore_errors=True)
    # The whole workspace, so that nothing is recompiled with fewer features.
    build = ["cargo", "build", "--quiet", "--workspace", "--example", "gpu_kernels"]
    subprocess.run(build, cwd=ROOT, check=True)
    example = [os.path.join(TARGET, "debug/examples/gpu_kernels"), folder]
    subprocess.run(example + ([arguments.kernels] if arguments.kernels else []), check=True)
    if arguments.isa:
        os.makedirs(arguments.isa, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(compiled, library, folder, chip, arguments.pattern, arguments.isa) for chip in CHIPS]
        made = {chip: job.result() for chip, job in zip(CHIPS, jobs)}
    driver = made[CHIPS[0]]["driver"]
    before = {"driver": driver, "kernels": {}}
    if os.path.exists(RECORD):
        with open(RECORD) as file:
            before = json.load(file)
    same = before["driver"] == driver
    faults, columns = [], [*KEPT, "spills"]
    print(f"{'kernel':54}{'chip':9}" + "".join(f"{name:>14}" for name in columns))
    for name in made[CHIPS[0]]["rows"]:
        for chip in CHIPS:
            now = made[chip]["rows"][name]
            kept = before["kernels"].get(name, {}).get(chip) if same else None
            faults += worse(name, chip, now, kept)
            cells = [f"{kept[k]}>{now[k]}" if kept and kept[k] != now[k] else str(now[k]) for k in columns]
            print(f"{name:54}{chip:9}" + "".join(f"{cell:>14}" for cell in cells))
    if not same:
        print(f"THE RECORD IS OF {before['driver']}, this is {driver}: only spills are looked at", file=sys.stderr)
    if arguments.keep:
        rows = [f"{json.dumps(name)}: {{\n" + ",\n".join(
            f"  {json.dumps(chip)}: {json.dumps(made[chip]['rows'][name])}" for chip in CHIPS) + "\n}"
            for name in made[CHIPS[0]]["rows"]]
        with open(RECORD, "w") as file:
            file.write(f'{{"driver": {json.dumps(driver)}, "kernels": {{\n' + ",\n".join(rows) + "\n}}\n")
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--chip"]:
        _, _, chip, library, folder, pattern, isa = sys.argv
        chip_main(library, folder, chip, pattern, isa)
    sys.exit(main())
