/* Reads JSON into nodes. */
#include "json_reader.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

enum { MAX_DEPTH = 128, CHUNK_SIZE = 32768 };

typedef struct {
  const char *at, *end;
  int depth;
  bool failed;
  char* chunk; /* of memory for nodes and texts: each mxMalloc takes the host its time */
  size_t used;
} reader;

static void* memory(reader* in, size_t size) {
  size = (size + 7) / 8 * 8;
  if (size > CHUNK_SIZE / 4) return mxMalloc(size);
  if (!in->chunk || in->used + size > CHUNK_SIZE) {
    in->chunk = mxMalloc(CHUNK_SIZE);
    in->used = 0;
  }
  in->used += size;
  return in->chunk + in->used - size;
}

static json_node* value(reader* in);

static json_node* fail(reader* in) {
  in->failed = true;
  return NULL;
}

static void skip_space(reader* in) {
  while (in->at < in->end && strchr(" \t\r\n", *in->at) && *in->at) ++in->at;
}

static bool take(reader* in, char wanted) {
  skip_space(in);
  if (in->at == in->end || *in->at != wanted) return false;
  ++in->at;
  return true;
}

static json_node* new_node(reader* in, enum json_type type) {
  json_node* node = memory(in, sizeof *node);
  memset(node, 0, sizeof *node);
  node->type = type;
  return node;
}

static unsigned hex4(reader* in) {
  char digits[5] = {0};
  char* end;
  if (in->end - in->at < 4) return (unsigned)(in->failed = true);
  memcpy(digits, in->at, 4);
  in->at += 4;
  const unsigned long code = strtoul(digits, &end, 16);
  if (end != digits + 4) in->failed = true;
  return (unsigned)code;
}

static char* put_escape(reader* in, char* to) {
  static const char names[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
  const char kind = in->at < in->end ? *in->at++ : '\0';
  const char* known = kind ? strchr(names, kind) : NULL;
  if (known) {
    *to++ = meant[known - names];
    return to;
  }
  if (kind != 'u') return in->failed = true, to;
  unsigned code = hex4(in);
  if (code >= 0xD800 && code < 0xDC00 && in->end - in->at >= 6 && in->at[0] == '\\' && in->at[1] == 'u') {
    in->at += 2;
    code = 0x10000 + ((code & 0x3FF) << 10) + (hex4(in) & 0x3FF);
  }
  return to + utf8_from_code(to, code);
}

static json_node* text(reader* in) { /* behind its quote */
  json_node* node = new_node(in, JSON_TEXT);
  const char* close = in->at;
  while (close < in->end && *close != '"') close += *close == '\\' ? 2 : 1;
  if (close >= in->end) return fail(in);
  char* copy = memory(in, (size_t)(close - in->at) + 1);
  char* to = copy;
  while (in->at < close && !in->failed) {
    if (*in->at == '\\') {
      ++in->at;
      to = put_escape(in, to);
    } else {
      *to++ = *in->at++;
    }
  }
  in->at = close + 1;
  *to = '\0';
  node->text = copy;
  node->size = (size_t)(to - copy);
  return node;
}

static json_node* number(reader* in) {
  char digits[64];
  size_t size = 0;
  while (in->at < in->end && size + 1 < sizeof digits && strchr("+-.0123456789eE", *in->at) && *in->at)
    digits[size++] = *in->at++;
  digits[size] = '\0';
  char* point = strchr(digits, '.');
  if (point) *point = *localeconv()->decimal_point; /* what strtod reads */
  char* end;
  json_node* node = new_node(in, JSON_NUMBER);
  node->number = strtod(digits, &end);
  return size == 0 || *end ? fail(in) : node;
}

static json_node* word(reader* in, const char* wanted, enum json_type type, double number) {
  const size_t size = strlen(wanted);
  if ((size_t)(in->end - in->at) < size || memcmp(in->at, wanted, size) != 0) return fail(in);
  in->at += size;
  json_node* node = new_node(in, type);
  node->number = number;
  return node;
}

/* Keys become names of fields: what these cannot have is an underscore. */
static const char* field_name(json_node* key) {
  char* name = (char*)key->text;
  for (char* c = name; *c; ++c)
    if (!((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9'))) *c = '_';
  return name;
}

static json_node* list(reader* in, char close, enum json_type type) {
  json_node* node = new_node(in, type);
  json_node** last = &node->first;
  if (take(in, close)) return node;
  do {
    json_node* key = NULL;
    if (type == JSON_OBJECT) {
      if (!take(in, '"')) return fail(in);
      key = text(in);
      if (!key || !take(in, ':')) return fail(in);
    }
    json_node* element = value(in);
    if (!element) return NULL;
    if (key) element->key = field_name(key);
    *last = element;
    last = &element->next;
    ++node->size;
  } while (take(in, ','));
  return take(in, close) ? node : fail(in);
}

static json_node* value(reader* in) {
  skip_space(in);
  if (in->at == in->end || in->depth >= MAX_DEPTH) return fail(in);
  ++in->depth;
  json_node* node;
  switch (*in->at) {
    case '{':
      ++in->at, node = list(in, '}', JSON_OBJECT);
      break;
    case '[':
      ++in->at, node = list(in, ']', JSON_LIST);
      break;
    case '"':
      ++in->at, node = text(in);
      break;
    case 't':
      node = word(in, "true", JSON_BOOLEAN, 1);
      break;
    case 'f':
      node = word(in, "false", JSON_BOOLEAN, 0);
      break;
    case 'n':
      node = word(in, "null", JSON_NULL, mxGetNaN());
      break;
    default:
      node = number(in);
  }
  --in->depth;
  return in->failed ? NULL : node;
}

json_node* json_parse(const char* text, size_t size) {
  reader in = {.at = text, .end = text + size};
  json_node* root = value(&in);
  skip_space(&in);
  return in.at == in.end ? root : NULL;
}

const json_node* json_member(const json_node* object, const char* key) {
  if (object && object->type == JSON_OBJECT)
    for (const json_node* member = object->first; member; member = member->next)
      if (strcmp(member->key, key) == 0) return member;
  return NULL;
}

const char* json_member_text(const json_node* object, const char* key) {
  const json_node* member = json_member(object, key);
  return member && member->type == JSON_TEXT ? member->text : "";
}
