#include "core/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool error_raise(struct error *e, int code, const char *format, ...)
{
    if (!error_raised(e)) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(e->text, sizeof e->text, format, arguments);
        va_end(arguments);
        e->code = code;
    }
    return false;
}

bool error_out_of_memory(struct error *e)
{
    return error_raise(e, ERROR_RUN, "out of memory");
}

bool error_within(struct error *e, const char *place)
{
    char text[sizeof e->text];
    if (!error_raised(e))
        return true;
    snprintf(text, sizeof text, "%.200s: %.390s", place, e->text);
    memcpy(e->text, text, sizeof text);
    return false;
}
