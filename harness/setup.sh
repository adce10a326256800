#!/usr/bin/env bash
# Installs what riprap needs and this machine lacks: a linker, and where there is no driver for a
# GPU the software one of Mesa; with --tests Python's venv too. Says so, and does nothing else.
set -euo pipefail

if ! command -v cargo >/dev/null; then
    echo "riprap: there is no cargo; install Rust 1.95 or later, see https://rustup.rs" >&2
    exit 1
fi

missing=()
command -v cc >/dev/null || missing+=(gcc libc6-dev)

# Whether a Vulkan driver is registered and its loader is there, or Mesa's OpenGL over EGL.
has_adapter() {
    [ "$(uname -s)" = Linux ] || return 0 # Metal and Direct3D come with the system.
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0 # The user names the driver.
    local libraries folder
    libraries=$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p)
    if [[ $libraries == *libvulkan.so.1* ]]; then
        for folder in /etc /usr/local/etc /usr/local/share /usr/share; do
            ! compgen -G "$folder/vulkan/icd.d/*.json" >/dev/null || return 0
        done
    fi
    [[ $libraries == *libEGL_mesa.so.0* ]]
}
has_adapter || missing+=(mesa-vulkan-drivers libvulkan1)

if [ "${1:-}" = --tests ] && ! python3 -c "import venv, ensurepip" 2>/dev/null; then
    missing+=(python3-venv)
fi

[ ${#missing[@]} -gt 0 ] || exit 0
if ! command -v apt-get >/dev/null; then
    echo "riprap: this machine lacks what Debian calls ${missing[*]}; install it, please" >&2
    exit 1
fi
sudo=
if [ "$(id -u)" -ne 0 ]; then
    sudo=sudo
    if ! command -v sudo >/dev/null; then
        echo "riprap: as root, please: apt-get install ${missing[*]}" >&2
        exit 1
    fi
fi
echo "riprap: installing ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { $sudo apt-get update &&
    DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y --no-install-recommends "${missing[@]}"; } \
    >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    echo "riprap: that failed; as root, please: apt-get update && apt-get install ${missing[*]}" >&2
    exit 1
fi
