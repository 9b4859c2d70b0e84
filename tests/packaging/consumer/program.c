/* A program in C: one answer. */
#include <sinew.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  sinew_robot* robot;
  char* error = NULL;
  if (sinew_abi() != SINEW_ABI) return 1;
  if (sinew_open("3pfs-g2", 7, SINEW_FILE, &robot, &error) != SINEW_OK) {
    puts(error);
    sinew_free(error);
    return 2;
  }
  sinew_session* session = sinew_session_new(robot);
  const char* question = "{\"query\": \"forward\", \"inputs\": [0.44, 0.42, 0.41]}";
  char* answer = sinew_ask(session, question, strlen(question), NULL);
  const int is_answered = answer != NULL && strstr(answer, "\"converged\"") != NULL;
  sinew_free(answer);
  sinew_release(session);
  sinew_release(robot);
  return is_answered ? 0 : 3;
}
