/* What a hand-written kernel is given and gives back; read by the C++ compiler and by cffi. */
#ifndef BENCH_JOB_H
#define BENCH_JOB_H

#include <stdint.h>

enum { BENCH_MATERIALS = 8 };

typedef struct BenchMaterial {
    float color[3];
    float metallic, roughness, specular, sheen, clearcoat;
    uint32_t kind; /* Whitted: 0 glass, 1 metal, 2 paint */
} BenchMaterial;

typedef struct BenchLight {
    float corner[3], edgeU[3], edgeV[3], n[3], radiance[3];
    float area;
} BenchLight;

typedef struct BenchJob {
    void* scene;
    float* image; /* width x height x 4 */
    uint32_t width, height, skip, threads;
    float eye[3], u[3], v[3], w[3], pixel[2];
    const uint32_t* triangles;
    const float* vertices;
    const float* normals;
    const uint32_t* materialOf; /* per primitive */
    const float* uvs;
    const uint8_t* texels;
    uint32_t texelWidth, texelHeight;
    const float* spheres;
    BenchMaterial materials[BENCH_MATERIALS];
    BenchLight light;
    float sky[3];
    float radius, offset, noiseScale, floorSize;
    float sun[3];
    uint64_t rays;  /* out */
    double seconds; /* out */
} BenchJob;

typedef struct BenchLimit {
    char name[32];
    uint64_t rays;
    double single, packet, coherent; /* seconds for all rays of the class, one thread */
} BenchLimit;

#endif
