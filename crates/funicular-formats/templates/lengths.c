/*
{%- for line in about %}
 *{% if !line.is_empty() %} {{ line }}{% endif %}
{%- endfor %}
 *
 * Lengths are in m, angles in degrees, R = Rz(yaw) Ry(pitch) Rx(roll). A pose outside the box is moved to its border, and
 * the result says so. Nothing is allocated, called or kept: the file needs no library, and every function can be called
 * from every thread. Define before this file, or for the compiler:
 *   {{ m }}_FLOAT to keep and sum the corrections in float,
 *   {{ m }}_DECLARATIONS to have the declarations alone, as from a header,
 *   {{ m }}_SQRT(v) for another square root than the one below.
 */
#ifndef {{ m }}_DECLARED
#define {{ m }}_DECLARED

#define {{ m }}_CABLES {{ cables }}
#define {{ m }}_AXES {{ axes }}

#ifdef {{ m }}_FLOAT
typedef float {{ p }}_real;
#else
typedef double {{ p }}_real;
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Unstrained length of a cable [m], numbered from 0; -1 for a cable that there is not. */
double {{ p }}_length_m(int cable, {{ parameters }});

/* Unstrained lengths of all cables [m]; returns the same as {{ p }}_outside. */
int {{ p }}_lengths_m({{ parameters }}, double length_m[{{ m }}_CABLES]);

/* Correction of the length of a straight cable alone [m], for firmware that has this length; 0 for no such cable. */
{{ p }}_real {{ p }}_correction_m(int cable, {{ parameters }});

/* Derivatives of the length of a cable along {{ arguments }} [m per m, m per degree]: times the rates of the
   coordinates they give the rate of the length. Returns the same as {{ p }}_outside, and -1 for no such cable. */
int {{ p }}_gradient(int cable, {{ parameters }}, double gradient[{{ m }}_AXES]);

/* 0 inside the box; else the sum of 1 << k for each coordinate k that is outside or not a number. */
int {{ p }}_outside({{ parameters }});

/* Lengths at {{ tests.len() }} poses against those of funicular: 0 if all agree, else the number of the first pose that does not, from 1. */
int {{ p }}_self_test(void);

#ifdef __cplusplus
}
#endif
#endif

#ifndef {{ m }}_DECLARATIONS
#include <float.h>

#define {{ m }}_TERMS {{ terms }}
#define {{ m }}_DEGREE {{ degree }}

static const double {{ p }}_from[{{ m }}_AXES] = { {% for v in from %}{{ v|fmt("{:e}") }}, {% endfor %}};
static const double {{ p }}_to[{{ m }}_AXES] = { {% for v in to %}{{ v|fmt("{:e}") }}, {% endfor %}};

/* Degrees of the Chebyshev polynomials of each product. */
static const unsigned char {{ p }}_degrees[{{ m }}_TERMS][{{ m }}_AXES] = {
{%- for exponents in exponents %}
  { {% for k in exponents %}{{ k }}, {% endfor %}},
{%- endfor %}
};

static const {{ p }}_real {{ p }}_coefficients[{{ m }}_CABLES][{{ m }}_TERMS] = {
{%- for row in coefficients %}
  {
{%- for c in row %}
    {{ c|fmt("{:e}") }},
{%- endfor %}
  },
{%- endfor %}
};

/* Ends of the cables on the frame, less what is fixed of the pose [m]. */
static const double {{ p }}_ends[{{ m }}_CABLES][3] = {
{%- for end in ends %}
  { {{ end[0]|fmt("{:e}") }}, {{ end[1]|fmt("{:e}") }}, {{ end[2]|fmt("{:e}") }} },
{%- endfor %}
};
{% if turns %}
/* Ends of the cables on the platform, in its axes [m]. */
static const double {{ p }}_attachments[{{ m }}_CABLES][3] = {
{%- for end in attachments %}
  { {{ end[0]|fmt("{:e}") }}, {{ end[1]|fmt("{:e}") }}, {{ end[2]|fmt("{:e}") }} },
{%- endfor %}
};
{% endif %}
/* Place in the box with what all cables need there. */
struct {{ p }}_place {
  int outside;
  double at[{{ m }}_AXES];
  {{ p }}_real variable[{{ m }}_AXES];
  {{ p }}_real powers[{{ m }}_AXES][{{ m }}_DEGREE + 2];
{%- if turns %}
  double rotation[3][3], pitch_axis[2];
{%- endif %}
};

#ifndef {{ m }}_SQRT
/* Newton's method from a line between the shortest and the longest cable, then from above. */
static double {{ p }}_root(double v) {
  double root = (v + {{ shortest|fmt("{:e}") }} * {{ longest|fmt("{:e}") }}) / ({{ shortest|fmt("{:e}") }} + {{ longest|fmt("{:e}") }});
  int i;
  root = 0.5 * (root + v / root);
  for (i = 0; i < 100; i++) {
    const double next = 0.5 * (root + v / root);
    if (!(next < root)) break;
    root = next;
  }
  return root;
}
#define {{ m }}_SQRT(v) {{ p }}_root(v)
#endif
{% if turns %}
/* Sine and cosine of an angle in degrees, by their series about the nearest right angle. */
static void {{ p }}_sin_cos(double degrees, double *sine, double *cosine) {
  const int turn = (int)(degrees / 90.0 + (degrees < 0.0 ? -0.5 : 0.5));
  const double a = (degrees - 90.0 * turn) * 1.7453292519943295e-2, b = a * a;
  const double s = a * (1.0 - b / 6.0 * (1.0 - b / 20.0 * (1.0 - b / 42.0 * (1.0 - b / 72.0 * (1.0 - b / 110.0 *
    (1.0 - b / 156.0 * (1.0 - b / 210.0 * (1.0 - b / 272.0))))))));
  const double c = 1.0 - b / 2.0 * (1.0 - b / 12.0 * (1.0 - b / 30.0 * (1.0 - b / 56.0 * (1.0 - b / 90.0 *
    (1.0 - b / 132.0 * (1.0 - b / 182.0 * (1.0 - b / 240.0)))))));
  switch (turn & 3) {
  case 0: *sine = s; *cosine = c; break;
  case 1: *sine = c; *cosine = -s; break;
  case 2: *sine = -s; *cosine = -c; break;
  default: *sine = -c; *cosine = s; break;
  }
}

static void {{ p }}_turn(struct {{ p }}_place *place) {
  double sr, cr, sp, cp, sy, cy;
{%- for (k, angle) in angles.iter().enumerate() %}
  {{ p }}_sin_cos({% match angle %}{% when Coordinate::Variable with (i) %}place->at[{{ i }}]{% when Coordinate::Fixed with (v) %}{{ v|fmt("{:e}") }}{% endmatch %}, {% if k == 0 %}&sr, &cr{% else if k == 1 %}&sp, &cp{% else %}&sy, &cy{% endif %});
{%- endfor %}
  place->rotation[0][0] = cy * cp; place->rotation[0][1] = cy * sp * sr - sy * cr; place->rotation[0][2] = cy * sp * cr + sy * sr;
  place->rotation[1][0] = sy * cp; place->rotation[1][1] = sy * sp * sr + cy * cr; place->rotation[1][2] = sy * sp * cr - cy * sr;
  place->rotation[2][0] = -sp; place->rotation[2][1] = cp * sr; place->rotation[2][2] = cp * cr;
  place->pitch_axis[0] = -sy; place->pitch_axis[1] = cy;
}

/* Lever arm of an attachment, in the axes of the world [m]. */
static void {{ p }}_lever(int cable, const struct {{ p }}_place *place, double lever[3]) {
  int i;
  for (i = 0; i < 3; i++)
    lever[i] = place->rotation[i][0] * {{ p }}_attachments[cable][0] + place->rotation[i][1] * {{ p }}_attachments[cable][1]
      + place->rotation[i][2] * {{ p }}_attachments[cable][2];
}
{% endif %}
static void {{ p }}_place_of(const double given[{{ m }}_AXES], struct {{ p }}_place *place) {
  int k, n;
  place->outside = 0;
  for (k = 0; k < {{ m }}_AXES; k++) {
    const double from = {{ p }}_from[k], to = {{ p }}_to[k];
    double at = given[k];
    {{ p }}_real t;
    /* Comparisons with what is not a number are false. */
    if (!(at >= from)) { at = from; place->outside |= 1 << k; }
    if (!(at <= to)) { at = to; place->outside |= 1 << k; }
    t = ({{ p }}_real)((2.0 * at - from - to) / (to - from));
    place->at[k] = at;
    place->variable[k] = t;
    place->powers[k][0] = 1;
    place->powers[k][1] = t;
    for (n = 2; n <= {{ m }}_DEGREE; n++)
      place->powers[k][n] = 2 * t * place->powers[k][n - 1] - place->powers[k][n - 2];
  }
{%- if turns %}
  {{ p }}_turn(place);
{%- endif %}
}

static {{ p }}_real {{ p }}_sum(int cable, const struct {{ p }}_place *place) {
  {{ p }}_real sum = 0;
  int i, k;
  for (i = 0; i < {{ m }}_TERMS; i++) {
    {{ p }}_real term = {{ p }}_coefficients[cable][i];
    for (k = 0; k < {{ m }}_AXES; k++) term *= place->powers[k][{{ p }}_degrees[i][k]];
    sum += term;
  }
  return sum;
}

/* Straight line from the platform to the frame [m]; returns its length. */
static double {{ p }}_straight(int cable, const struct {{ p }}_place *place, double line[3]) {
{%- if turns %}
  double lever[3];
  {{ p }}_lever(cable, place, lever);
{%- endif %}
{%- for (k, coordinate) in position.iter().enumerate() %}
  line[{{ k }}] = {{ p }}_ends[cable][{{ k }}]{% match coordinate %}{% when Coordinate::Variable with (i) %} - place->at[{{ i }}]{% when Coordinate::Fixed with (_v) %}{% endmatch %}{% if turns %} - lever[{{ k }}]{% endif %};
{%- endfor %}
  return {{ m }}_SQRT(line[0] * line[0] + line[1] * line[1] + line[2] * line[2]);
}

static double {{ p }}_length_at(int cable, const struct {{ p }}_place *place) {
  double line[3];
  return {{ p }}_straight(cable, place, line) + (double){{ p }}_sum(cable, place);
}

double {{ p }}_length_m(int cable, {{ parameters }}) {
  const double given[{{ m }}_AXES] = { {{ arguments }} };
  struct {{ p }}_place place;
  if (cable < 0 || cable >= {{ m }}_CABLES) return -1.0;
  {{ p }}_place_of(given, &place);
  return {{ p }}_length_at(cable, &place);
}

int {{ p }}_lengths_m({{ parameters }}, double length_m[{{ m }}_CABLES]) {
  const double given[{{ m }}_AXES] = { {{ arguments }} };
  struct {{ p }}_place place;
  int cable;
  {{ p }}_place_of(given, &place);
  for (cable = 0; cable < {{ m }}_CABLES; cable++) length_m[cable] = {{ p }}_length_at(cable, &place);
  return place.outside;
}

{{ p }}_real {{ p }}_correction_m(int cable, {{ parameters }}) {
  const double given[{{ m }}_AXES] = { {{ arguments }} };
  struct {{ p }}_place place;
  if (cable < 0 || cable >= {{ m }}_CABLES) return 0;
  {{ p }}_place_of(given, &place);
  return {{ p }}_sum(cable, &place);
}

int {{ p }}_outside({{ parameters }}) {
  const double given[{{ m }}_AXES] = { {{ arguments }} };
  struct {{ p }}_place place;
  {{ p }}_place_of(given, &place);
  return place.outside;
}

int {{ p }}_gradient(int cable, {{ parameters }}, double gradient[{{ m }}_AXES]) {
  const double given[{{ m }}_AXES] = { {{ arguments }} };
  struct {{ p }}_place place;
  double line[3], length;
  int axis, i, k, n;
  if (cable < 0 || cable >= {{ m }}_CABLES) return -1;
  {{ p }}_place_of(given, &place);
  length = {{ p }}_straight(cable, &place, line);
  for (axis = 0; axis < {{ m }}_AXES; axis++) {
    {{ p }}_real slopes[{{ m }}_DEGREE + 2], sum = 0;
    slopes[0] = 0;
    slopes[1] = 1;
    for (n = 2; n <= {{ m }}_DEGREE; n++)
      slopes[n] = 2 * place.powers[axis][n - 1] + 2 * place.variable[axis] * slopes[n - 1] - slopes[n - 2];
    for (i = 0; i < {{ m }}_TERMS; i++) {
      {{ p }}_real term = {{ p }}_coefficients[cable][i] * slopes[{{ p }}_degrees[i][axis]];
      for (k = 0; k < {{ m }}_AXES; k++)
        if (k != axis) term *= place.powers[k][{{ p }}_degrees[i][k]];
      sum += term;
    }
    gradient[axis] = (double)sum * 2.0 / ({{ p }}_to[axis] - {{ p }}_from[axis]);
  }
{%- if turns %}
  {
    const double radian = 1.7453292519943295e-2;
    double lever[3], turned[3];
    {{ p }}_lever(cable, &place, lever);
    turned[0] = line[2] * lever[1] - line[1] * lever[2];
    turned[1] = line[0] * lever[2] - line[2] * lever[0];
    turned[2] = line[1] * lever[0] - line[0] * lever[1];
    for (i = 0; i < 3; i++) turned[i] *= -radian / length;
{%- endif %}
{%- for (k, axis) in variables.iter().enumerate() %}
{%- if axis < &3 %}
  gradient[{{ k }}] -= line[{{ axis }}] / length;
{%- else if axis == &3 %}
    gradient[{{ k }}] += place.rotation[0][0] * turned[0] + place.rotation[1][0] * turned[1] + place.rotation[2][0] * turned[2];
{%- else if axis == &4 %}
    gradient[{{ k }}] += place.pitch_axis[0] * turned[0] + place.pitch_axis[1] * turned[1];
{%- else %}
    gradient[{{ k }}] += turned[2];
{%- endif %}
{%- endfor %}
{%- if turns %}
  }
{%- endif %}
  return place.outside;
}

static const double {{ p }}_tested[{{ tests.len() }}][{{ m }}_AXES] = {
{%- for test in tests %}
  { {% for v in test.at %}{{ v }}, {% endfor %}},
{%- endfor %}
};

static const double {{ p }}_tested_lengths[{{ tests.len() }}][{{ m }}_CABLES] = {
{%- for test in tests %}
  { {% for v in test.lengths %}{{ v }}, {% endfor %}},
{%- endfor %}
};

int {{ p }}_self_test(void) {
#ifdef {{ m }}_FLOAT
  const double epsilon = FLT_EPSILON;
#else
  const double epsilon = DBL_EPSILON;
#endif
  int i, cable;
  for (i = 0; i < {{ tests.len() }}; i++) {
    struct {{ p }}_place place;
    {{ p }}_place_of({{ p }}_tested[i], &place);
    for (cable = 0; cable < {{ m }}_CABLES; cable++) {
      const double length = {{ p }}_tested_lengths[i][cable];
      const double error = {{ p }}_length_at(cable, &place) - length;
      /* Rounding of the coefficients and of their sum, and of the length. */
      const double limit = {{ size|fmt("{:e}") }} * epsilon * ({{ m }}_DEGREE + 4) + length * DBL_EPSILON * 8;
      if (!(error <= limit && -error <= limit)) return i + 1;
    }
  }
  return 0;
}
#endif
