/* The C interface from C: the example at the top of sinew.h, and nothing of C++ in the header. */
#include <stdio.h>
#include <string.h>

#include "sinew.h"

int main(void) {
  sinew_robot* robot = NULL;
  char* error = NULL;
  const char* question = "{\"query\": \"forward\", \"inputs\": [0.44, 0.42, 0.41]}";
  sinew_session* session;
  char* answer;
  int solved;
  if (sinew_abi() != SINEW_ABI) return 1;
  if (sinew_open("3pfs-g2", 7, SINEW_FILE, &robot, &error) != SINEW_OK) {
    puts(error);
    sinew_free(error);
    return 2;
  }
  session = sinew_session_new(robot);
  answer = sinew_ask(session, question, strlen(question), NULL);
  if (!answer) return 3;
  puts(answer);
  solved = strstr(answer, "\"status\":\"converged\"") != NULL;
  sinew_free(answer);
  sinew_release(session);
  sinew_release(robot);
  return solved ? 0 : 4;
}
