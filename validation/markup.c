/* Text inside XML and HTML. XML 1.0 has no way at all to write most control characters, so they are dropped. */
#include "markup.h"

void markup_text(FILE *file, const char *text)
{
    for (; text && *text; text++)
        switch (*text) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        default:
            if ((unsigned char)*text >= 32 || *text == '\n' || *text == '\t')
                fputc(*text, file);
        }
}
