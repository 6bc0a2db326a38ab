// Gradient noise and the principled BRDF, for one number or many.
#ifndef BENCH_SURFACE_H
#define BENCH_SURFACE_H

#include "algebra.h"

namespace bench {

template <class U> BENCH_INLINE U latticeHash(U x, U y, U z) {
    U h = (x * U(73856093u)) ^ (y * U(19349663u)) ^ (z * U(83492791u));
    h = (h ^ (h >> 15u)) * U(2246822519u);
    return h ^ (h >> 13u);
}

// The dot product with one of Perlin's twelve gradients.
template <class F> BENCH_INLINE F gradient(UintOf<F> h, F x, F y, F z) {
    using U = UintOf<F>;
    h = h & U(15u);
    const F u = select(h < U(8u), x, y);
    const F v = select(h < U(4u), y, select((h & U(13u)) == U(12u), x, z));
    return select((h & U(1u)) == U(0u), u, -u) + select((h & U(2u)) == U(0u), v, -v);
}

template <class F> BENCH_INLINE F fade(F t) { return t * t * t * (t * (t * F(6.0f) - F(15.0f)) + F(10.0f)); }
template <class F> BENCH_INLINE F mix(F a, F b, F t) { return a + t * (b - a); }

template <class F> BENCH_INLINE F noise(Vec<F> p) {
    using U = UintOf<F>;
    const F cx = roundDown(p.x), cy = roundDown(p.y), cz = roundDown(p.z);
    const F x = p.x - cx, y = p.y - cy, z = p.z - cz;
    const F x1 = x - F(1.0f), y1 = y - F(1.0f), z1 = z - F(1.0f);
    const U i = toInteger(cx), j = toInteger(cy), k = toInteger(cz), one = U(1u);
    const F u = fade(x), v = fade(y), w = fade(z);
    const F front = mix(mix(gradient(latticeHash(i, j, k), x, y, z), gradient(latticeHash(i + one, j, k), x1, y, z), u),
                        mix(gradient(latticeHash(i, j + one, k), x, y1, z), gradient(latticeHash(i + one, j + one, k), x1, y1, z), u), v);
    const F back =
        mix(mix(gradient(latticeHash(i, j, k + one), x, y, z1), gradient(latticeHash(i + one, j, k + one), x1, y, z1), u),
            mix(gradient(latticeHash(i, j + one, k + one), x, y1, z1), gradient(latticeHash(i + one, j + one, k + one), x1, y1, z1), u), v);
    return mix(front, back, w);
}

template <class F> inline F octaves(Vec<F> p, int count) {
    F total(0.0f);
    float height = 0.5f;
    for (int i = 0; i < count; i++) {
        total = total + F(height) * noise(p);
        p = F(2.0f) * p;
        height *= 0.5f;
    }
    return total;
}

template <class F> struct Principled {
    Vec<F> color;
    F metallic, roughness, specular, sheen, clearcoat;
};

template <class F> BENCH_INLINE F schlick(F cosine) {
    const F m = minimum(maximum(F(1.0f) - cosine, F(0.0f)), F(1.0f));
    return m * m * (m * m) * m;
}
template <class F> BENCH_INLINE F ggx(F nh, F alpha) {
    const F a2 = alpha * alpha;
    const F t = F(1.0f) + (a2 - F(1.0f)) * nh * nh;
    return a2 / (F(3.141592654f) * t * t);
}
template <class F> BENCH_INLINE F smith(F nv, F alpha) {
    const F a2 = alpha * alpha;
    return F(1.0f) / (nv + squareRoot(a2 + nv * nv - a2 * nv * nv));
}

// `surface.color` and `surface.roughness` are those at the point. The caller sees to it that wo and wi are above the surface.
template <class F> BENCH_INLINE Vec<F> principledAbove(const Principled<F>& surface, F nl, F nv, Vec<F> n, Vec<F> wo, Vec<F> wi) {
    const F one(1.0f);
    const Vec<F> h = normalize(wo + wi);
    const F nh = dot(n, h), lh = dot(wi, h);
    const F luminance = F(0.3f) * surface.color.x + F(0.6f) * surface.color.y + F(0.1f) * surface.color.z;
    const Vec<F> tint = select(luminance > F(0.0f), (one / luminance) * surface.color, Vec<F>(one, one, one));
    const F fl = schlick(nl), fv = schlick(nv), fh = schlick(lh);
    const F fd90 = F(0.5f) + F(2.0f) * lh * lh * surface.roughness;
    const F diffuse = (one + (fd90 - one) * fl) * (one + (fd90 - one) * fv);
    const F dielectric = F(0.08f) * surface.specular * (one - surface.metallic);
    const Vec<F> base = Vec<F>(dielectric, dielectric, dielectric) + surface.metallic * surface.color;
    const F alpha = maximum(F(0.001f), surface.roughness * surface.roughness);
    const Vec<F> fresnel = base + fh * (Vec<F>(one, one, one) - base);
    const Vec<F> reflected = (ggx(nh, alpha) * smith(nl, alpha) * smith(nv, alpha)) * fresnel;
    const F coat = F(0.25f) * surface.clearcoat * (F(0.04f) + F(0.96f) * fh) * ggx(nh, F(0.1f)) * smith(nl, F(0.25f)) * smith(nv, F(0.25f));
    const Vec<F> soft = (F(0.318309886f) * diffuse) * surface.color + (fh * surface.sheen) * tint;
    return (one - surface.metallic) * soft + reflected + Vec<F>(coat, coat, coat);
}

}  // namespace bench
#endif
