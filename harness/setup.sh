#!/usr/bin/env bash
# Installs missing requirements of riprap: a linker, and, if no Vulkan driver works, Mesa's software Vulkan
# driver lavapipe. With --tests also Python's venv; with --adapters also the other software
# adapters: OpenGL over EGL, and SwiftShader in <target>/swiftshader. Prints what it installs.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

if ! command -v cargo >/dev/null; then
    echo "riprap: there is no cargo; install Rust 1.95 or later, see https://rustup.rs" >&2
    exit 1
fi

# as_root [-n] COMMAND...: with -n it fails instead of asking for a password.
as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        [ "$1" != -n ] || shift
        "$@"
    else
        sudo "$@"
    fi
}

# install [-n] PACKAGE...: returns false if the installation fails or is impossible, with the reason in $reason.
install() {
    local ask=()
    if [ "$1" = -n ]; then
        ask=(-n)
        shift
    fi
    if ! command -v apt-get >/dev/null; then
        reason="there is no apt-get; install what Debian calls $*"
    elif [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
        reason="as root: apt-get update && apt-get install $*"
    else
        echo "riprap: installing $*"
        if { as_root "${ask[@]}" apt-get update &&
            as_root "${ask[@]}" env DEBIAN_FRONTEND=noninteractive \
                apt-get install -y --no-install-recommends "$@"; } >"$scratch/log" 2>&1 </dev/null; then
            reason="$* are installed, but find no device"
            return
        fi
        [ ${#ask[@]} -gt 0 ] || cat "$scratch/log" >&2
        reason="that failed; as root: apt-get update && apt-get install $*"
    fi
    return 1
}

fail() {
    echo "riprap: $1" >&2
    exit 1
}

missing=()
command -v cc >/dev/null || missing+=(gcc libc6-dev)
if [[ " $* " == *" --tests "* ]] && ! python3 -c "import venv, ensurepip" 2>/dev/null; then
    missing+=(python3-venv)
fi
[ ${#missing[@]} -eq 0 ] || install "${missing[@]}" || fail "$reason"

[ "$(uname -s)" = Linux ] || exit 0 # Metal and Direct3D come with the system.

# works vulkan|egl: whether a driver of this API finds a device.
cc -o "$scratch/probe" "$root/harness/probe.c" -ldl
works() { timeout 60 "$scratch/probe" "$1" 2>/dev/null; }

lavapipe=(mesa-vulkan-drivers libvulkan1)
if ! works vulkan; then
    named=${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}
    if [ -n "$named" ]; then
        reason="VK_DRIVER_FILES or VK_ICD_FILENAMES names $named, which does not work"
    elif works egl; then
        install -n "${lavapipe[@]}" || true
    else
        install "${lavapipe[@]}" || fail "$reason"
    fi
    if ! works vulkan; then
        works egl || fail "no adapter: $reason"
        echo "riprap: OpenGL over EGL instead of Vulkan, at about half the speed: $reason" >&2
    fi
fi

[[ " $* " == *" --adapters "* ]] || exit 0
works egl || { install libegl1 libgl1-mesa-dri && works egl; } || fail "$reason"
target=${CARGO_TARGET_DIR:-$root/target}
[[ $target == /* ]] || target=$root/$target
driver=$target/swiftshader
[ ! -e "$driver/vk_swiftshader_icd.json" ] || exit 0
# Debian ships SwiftShader in a package of Chromium, of which only two files are needed.
mkdir -p "$driver"
cd "$scratch"
echo "riprap: unpacking SwiftShader from chromium-common"
as_root apt-get update >log 2>&1 && apt-get download chromium-common >log 2>&1 ||
    { cat log >&2; fail "SwiftShader, which the package chromium-common holds, cannot be downloaded"; }
dpkg-deb --fsys-tarfile chromium-common_*.deb |
    tar -x -C "$driver" --strip-components=4 ./usr/lib/chromium/libvk_swiftshader.so ./usr/lib/chromium/vk_swiftshader_icd.json
