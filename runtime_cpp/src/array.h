// Owned plain data for Embree and for kernels: cache-line aligned, fixed in size and address, with 16 readable zero bytes after the end,
// because both read whole vectors.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>

namespace oxrt {

template <class T>
class Array {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Array() = default;

    // Elements are zero.
    explicit Array(std::size_t size) : elements(allocate(size)), count(size) {}

    Array(const T* source, std::size_t size) : Array(size)
    {
        if (size != 0) std::memcpy(elements.get(), source, size * sizeof(T));
    }

    // Nothing stays nothing: some tell by the address whether there is an array.
    Array(const Array& original)
    {
        if (original.elements) *this = Array(original.data(), original.size());
    }
    Array(Array&&) = default;
    Array& operator=(Array&&) = default;

    T* data() { return elements.get(); }
    const T* data() const { return elements.get(); }
    std::size_t size() const { return count; }
    std::size_t bytes() const { return elements ? allocatedBytes(count) : 0; }
    T& operator[](std::size_t i) { return elements[i]; }
    const T& operator[](std::size_t i) const { return elements[i]; }

private:
    struct Free {
        void operator()(T* memory) const { std::free(memory); }
    };

    static constexpr std::size_t alignment = 64;
    static constexpr std::size_t padding = 16;

    static std::size_t allocatedBytes(std::size_t size)
    {
        if (size > (std::numeric_limits<std::size_t>::max() / 2) / sizeof(T)) throw std::bad_alloc();
        return (size * sizeof(T) + padding + alignment - 1) / alignment * alignment;
    }

    static T* allocate(std::size_t size)
    {
        const std::size_t allocated = allocatedBytes(size);
        void* memory = std::aligned_alloc(alignment, allocated);
        if (!memory) throw std::bad_alloc();
        std::memset(memory, 0, allocated);
        return static_cast<T*>(memory);
    }

    std::unique_ptr<T[], Free> elements;
    std::size_t count = 0;
};

} // namespace oxrt
