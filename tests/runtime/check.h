// The least that a test needs: CHECK prints the failed expression and its values, TEST registers a function, main runs those whose name
// contains the argument (all without one).
#pragma once

#include "oxrt/oxrt.h"

#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

namespace check {

struct Test {
    const char* name;
    void (*run)();
};

inline std::vector<Test>& tests()
{
    static std::vector<Test> all;
    return all;
}

inline int failures = 0;

struct Registration {
    Registration(const char* name, void (*run)()) { tests().push_back({name, run}); }
};

template <class A, class B>
void equal(const A& a, const B& b, const char* text, const char* file, int line)
{
    if (a == b) return;
    ++failures;
    std::cerr << file << ":" << line << ": " << text << ": " << a << " is not " << b << std::endl;
}

inline void result(OxrtResult got, OxrtResult expected, const char* fragment, const char* text, const char* file, int line)
{
    const std::string message = oxrtGetLastErrorMessage();
    const bool said = !fragment || message.find(fragment) != std::string::npos;
    if (got == expected && said) return;
    ++failures;
    std::cerr << file << ":" << line << ": " << text << ": " << oxrtGetErrorName(got) << " is not " << oxrtGetErrorName(expected)
              << " (message: \"" << message << "\", expected in it: \"" << (fragment ? fragment : "") << "\")" << std::endl;
}

inline int runAll(int argc, char** argv)
{
    int run = 0;
    for (const Test& test : tests()) {
        if (argc > 1 && !std::strstr(test.name, argv[1])) continue;
        const int before = failures;
        test.run();
        std::printf("%s %s\n", failures == before ? "ok  " : "FAIL", test.name);
        std::fflush(stdout);
        ++run;
    }
    std::printf("%d tests, %d failed checks\n", run, failures);
    return failures != 0 || run == 0;
}

} // namespace check

#define TEST(name)                                                                                                                         \
    static void name();                                                                                                                    \
    static const check::Registration name##Registration(#name, name);                                                                      \
    static void name()

#define CHECK(condition) check::equal(static_cast<bool>(condition), true, #condition, __FILE__, __LINE__)
#define CHECK_EQUAL(a, b) check::equal(a, b, #a " == " #b, __FILE__, __LINE__)
#define CHECK_SUCCESS(call) check::result(call, OXRT_SUCCESS, nullptr, #call, __FILE__, __LINE__)
// The message must contain the fragment.
#define CHECK_FAILS(call, code, fragment) check::result(call, code, fragment, #call, __FILE__, __LINE__)
