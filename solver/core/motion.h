/* The two movements that every step is made of. */
#ifndef CORE_MOTION_H
#define CORE_MOTION_H

#include "core/suspension.h"

void kick(struct suspension *s, double duration, double ahead);        /* U += duration F/m,  W += duration T/I; ahead: core/driven.h */
void drift(struct suspension *s, double duration);      /* x += duration U, and the angle turned where it is kept */

#endif
