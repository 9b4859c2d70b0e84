% The code of docs/octave.md, in order and in one workspace, prints what the page shows; `...` stands for anything.
1;

function check_page (page)
  blocks = regexp (fileread (page), '```octave\n(.*?)```\n(?:```text\n(.*?)```\n)?', 'tokens');
  assert (numel (blocks) >= 6);
  for k = 1:numel (blocks)
    code = blocks{k}{1};
    assignin ('base', 'shown_code', code);
    printed = evalin ('base', 'evalc (shown_code)');
    shown = '';
    if numel (blocks{k}) > 1
      shown = blocks{k}{2};
    end
    pattern = strrep (regexptranslate ('escape', tidy (shown)), '\.\.\.', '.*?');
    if isempty (regexp (tidy (printed), ['^', pattern, '$'], 'once'))
      error ('%s\nprints\n%s\nnot\n%s', code, printed, shown);
    end
  end
end

function text = tidy (text)
  text = strtrim (regexprep (regexprep (text, '[ \t]+\n', "\n"), '\n+', "\n"));
end

check_page (fullfile (getenv ('SINEW_DOCS'), 'octave.md'));
printf ('page: fine\n');
