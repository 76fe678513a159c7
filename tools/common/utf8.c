/* SPDX-License-Identifier: MIT */
#include "utf8.h"

size_t utf8_length(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    const size_t length = b[0] < 0x80 ? 1 : b[0] < 0xe0 ? 2 : b[0] < 0xf0 ? 3 : 4;

    if (length == 1)
        return 1;
    if (b[0] < 0xc2 || b[0] > 0xf4)
        return 0;
    const unsigned char low = b[0] == 0xe0 ? 0xa0 : b[0] == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = b[0] == 0xed ? 0x9f : b[0] == 0xf4 ? 0x8f : 0xbf;
    if (b[1] < low || b[1] > high)
        return 0;
    for (size_t i = 2; i < length; i++)
        if (b[i] < 0x80 || b[i] > 0xbf)
            return 0;
    return length;
}

size_t utf8_printable(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;

    if (b[0] < 0x20 || b[0] == 0x7f || (b[0] == 0xc2 && b[1] >= 0x80 && b[1] < 0xa0))
        return 0;
    return utf8_length(at);
}
