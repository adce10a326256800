/* Exit status 0 if the named interface has a device: `probe vulkan`, or `probe egl` for OpenGL without a display.
 * It loads the libraries as wgpu does, because files of a driver alone do not tell whether the driver works here. */
#include <dlfcn.h>
#include <stdint.h>
#include <string.h>

/* VkInstanceCreateInfo; all zeros but its type, 1, ask for Vulkan 1.0 without layers and extensions. */
struct create_info {
    int type;
    const void *next;
    uint32_t flags;
    const void *application;
    uint32_t layer_count;
    const char *const *layers;
    uint32_t extension_count;
    const char *const *extensions;
};

static int vulkan(void) {
    void *library = dlopen("libvulkan.so.1", RTLD_NOW), *instance = 0;
    if (!library) return 0;
    int (*create)(const struct create_info *, void *, void **) = dlsym(library, "vkCreateInstance");
    int (*list)(void *, uint32_t *, void *) = dlsym(library, "vkEnumeratePhysicalDevices");
    struct create_info info = {.type = 1};
    uint32_t count = 0;
    return create && list && create(&info, 0, &instance) == 0 && list(instance, &count, 0) == 0 && count > 0;
}

static int egl(void) {
    void *library = dlopen("libEGL.so.1", RTLD_NOW);
    if (!library) return 0;
    void *(*get)(unsigned, void *, const intptr_t *) = dlsym(library, "eglGetPlatformDisplay");
    unsigned (*initialize)(void *, int *, int *) = dlsym(library, "eglInitialize");
    const unsigned surfaceless = 0x31DD;
    const intptr_t none = 0x3038;
    void *display = get && initialize ? get(surfaceless, 0, &none) : 0;
    return display && initialize(display, 0, 0);
}

int main(int count, char **arguments) {
    return !(count == 2 && (strcmp(arguments[1], "egl") == 0 ? egl() : vulkan()));
}
