# cmake -D PROGRAM= -D WORDS= -D FILE= -P SinewCapture.cmake: what a program prints, in a file.
separate_arguments(WORDS)
get_filename_component(folder ${FILE} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
execute_process(COMMAND ${PROGRAM} ${WORDS} OUTPUT_FILE ${FILE}.part COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${FILE}.part ${FILE})
