// A program that renders ambient occlusion of a mesh, to compare peak memory with. Arguments: file of vertices, file of indices (both raw),
// file of a BenchJob without pointers, Embree configuration. Prints the peak resident size in KiB.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vector>

#include "job.h"

extern "C" {
void* bench_device_create(const char* configuration);
void* bench_scene_create(void* device);
void bench_scene_add_triangles(void* device, void* scene, const float* vertices, size_t vertexCount, const unsigned* indices,
                               size_t triangleCount);
void bench_scene_commit(void* scene, int join);
void ambient_occlusion_scalar(BenchJob* job);
}

template <class T> static std::vector<T> readAll(const char* path) {
    FILE* file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(1);
    }
    fseek(file, 0, SEEK_END);
    std::vector<T> items(size_t(ftell(file)) / sizeof(T));
    rewind(file);
    if (fread(items.data(), sizeof(T), items.size(), file) != items.size()) exit(1);
    fclose(file);
    return items;
}

int main(int, char** arguments) {
    const std::vector<float> vertices = readAll<float>(arguments[1]);
    const std::vector<uint32_t> triangles = readAll<uint32_t>(arguments[2]);
    BenchJob job = readAll<BenchJob>(arguments[3])[0];
    void* device = bench_device_create(arguments[4]);
    void* scene = bench_scene_create(device);
    bench_scene_add_triangles(device, scene, vertices.data(), vertices.size() / 3, triangles.data(), triangles.size() / 3);
    bench_scene_commit(scene, 0);
    std::vector<float> image(size_t(job.width) * job.height * 4);
    job.scene = scene;
    job.image = image.data();
    job.vertices = vertices.data();
    job.triangles = triangles.data();
    ambient_occlusion_scalar(&job);
    // not getrusage: its peak may be that of the process which started this one
    FILE* status = fopen("/proc/self/status", "r");
    for (char line[256]; fgets(line, sizeof line, status);)
        if (!strncmp(line, "VmHWM:", 6)) printf("%ld\n", atol(line + 6));
    return 0;
}
