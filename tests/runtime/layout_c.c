/* Layouts as a C compiler sees them. */
#include "layout.h"

int layoutOfC(void);

int layoutOfC(void)
{
    return (int)sizeof(OxrtLaunch);
}
