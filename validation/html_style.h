/* How the report looks. */
#ifndef HTML_STYLE_H
#define HTML_STYLE_H

extern const char html_style[], html_style_coverage[];

#endif
