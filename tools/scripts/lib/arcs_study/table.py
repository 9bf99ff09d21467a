import json,glob,re,sys,math
out='/tmp/x/joinout/'
tags=sys.argv[1:]
ref=tags[0]
r={}
for f in glob.glob(out+'*.json'):
    n=f[len(out):-5]; p=n.rsplit('-',1)
    if p[1] in tags:
        j=json.load(open(f))[0]; r.setdefault(p[0],{})[p[1]]=(j['3d_m']['rmse'],j['within_three_sigma'])
lg={}
for k in sorted(r):
    print(k,'  '.join(f"{t} {r[k][t][0]:.3f} ({100*r[k][t][1]:.1f}%)" for t in tags if t in r[k]))
    for t in tags[1:]:
        if t in r[k] and ref in r[k]:
            q=math.log(r[k][t][0]/r[k][ref][0]); lg.setdefault((t,k.split('-')[-2],k.split('-')[-1]),[]).append(q); lg.setdefault((t,'all'),[]).append(q)
for k in sorted(lg): print(k,len(lg[k]),'geo ratio %.3f'%math.exp(sum(lg[k])/len(lg[k])))
