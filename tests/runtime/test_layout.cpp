// Layouts as a C++ compiler sees them; the work is done by the compiler.
#include "layout.h"

#include "check.h"

extern "C" int layoutOfC(void);

TEST(cAndCppAgreeAboutTheLaunch)
{
    CHECK_EQUAL(layoutOfC(), static_cast<int>(sizeof(OxrtLaunch)));
}

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
