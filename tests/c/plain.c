/* The header is C, and this is how a program in C calls it. */
#include <stdlib.h>
#include <string.h>

#include "lacquer_c.h"

/* The number of bytes of the fragment shader of a file's material of that name; 0 when something fails. */
size_t fragmentBytesFromC(const char* path, const char* name) {
  const char* json = "{\"targets\": [\"essl\"], \"validate\": false}";
  lacquer_messages* messages = lacquer_messages_new();
  lacquer_options* options = lacquer_options_new(json, strlen(json), messages);
  lacquer_scene* scene = lacquer_scene_load(path, options, messages);
  size_t material = lacquer_scene_find_material(scene, name, messages);
  lacquer_graph* graph = lacquer_scene_graph(scene, material, LACQUER_UNUSED_ATTRIBUTES, options, messages);
  lacquer_shader* shader = lacquer_graph_generate(graph, options, messages);
  size_t size = 0;
  const char* text = lacquer_shader_text(shader, "essl", LACQUER_FRAGMENT, &size);
  if (strlen(text) != size || lacquer_messages_have_error(messages)) size = 0;
  lacquer_scene_free(scene);
  lacquer_options_free(options);
  lacquer_graph_free(graph);
  lacquer_shader_free(shader);
  lacquer_messages_free(messages);
  return size;
}
