// name: sanitizers
// kind: table
// description: Which sanitizers clean which kind of data, how, and who else reads the same channels, cleaning or not?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns sanitizer: string, name of the sanitizer
// returns category: string, a kind of data that it cleans: one that its label names, or one that gets to it
// returns gets: boolean, whether data of that kind gets to it
// returns method: string, anonymise, aggregate, drop or pseudonymise; the last leaves personal data
// returns stated: boolean, whether the label states the method
// returns label: string, file:line of the label that decides
// returns channels: list of string, channels from which it reads the category and that others read too
// returns others: list of string, who gets the category from these channels beside it
// returns cleaning: list of string, those of the others that are said to clean it, too: only the rest get it as it is
// order: robot, sanitizer, category
MATCH (:DataCategory)<-[:SANITIZES]-(e:Element)
WHERE $robot = '' OR e.robot = $robot
WITH DISTINCT e
WITH e, COLLECT { MATCH ()-[i:FLOWS_TO]->(e)
                  UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS kind
                  RETURN DISTINCT kind } AS arriving,
     COLLECT { MATCH (e)-[:SANITIZES]->(c:DataCategory) RETURN DISTINCT c.name } AS named
UNWIND [k IN e.sanitizes WHERE k IN arriving OR k IN named] AS kind
CALL (e, kind) {
  MATCH (e)-[s:SANITIZES]->(:DataCategory)<-[up:BROADER*0..]-(:DataCategory {name: kind})
  WITH s, up, coalesce(s.stated, s.method IS NOT NULL) AS stated, coalesce(s.file + ':' + s.line, 'by hand') AS label
  ORDER BY coalesce(s.tier, 2) DESC, coalesce(s.specificity, 1000000) DESC, coalesce(s.every, false), size(up), stated,
           label LIMIT 1
  RETURN coalesce(s.method, 'pseudonymise') AS method, stated, label
}
CALL (e, kind) {
  MATCH (channel:Topic|Service|Action)-[f:FLOWS_TO WHERE kind IN f.passes]->()
        ((:Wildcard)-[g:FLOWS_TO WHERE kind IN g.passes]->()){0,1}(e)
  WITH DISTINCT e, kind, channel
  MATCH (channel)-[f:FLOWS_TO WHERE kind IN f.passes]->()
        ((:Wildcard)-[g:FLOWS_TO WHERE kind IN g.passes]->()){0,1}(o:Element WHERE NOT o:Topic|Service|Action)
  WHERE o <> e
  RETURN channel.name AS channel, o.name AS other, kind IN coalesce(o.sanitizes, []) AS cleans
UNION
  RETURN null AS channel, null AS other, false AS cleans
}
WITH e, kind, arriving, method, stated, label, channel, other, cleans ORDER BY channel
WITH e, kind, kind IN arriving AS gets, method, stated, label, collect(DISTINCT channel) AS channels,
     collect(other) AS names, collect(CASE WHEN cleans THEN other END) AS too
CALL (names) {
  UNWIND names AS other
  WITH DISTINCT other ORDER BY other
  RETURN collect(other) AS others
}
CALL (too) {
  UNWIND too AS other
  WITH DISTINCT other ORDER BY other
  RETURN collect(other) AS cleaning
}
RETURN e.robot AS robot, e.name AS sanitizer, kind AS category, gets, method, stated, label, channels, others, cleaning
ORDER BY robot, sanitizer, category
